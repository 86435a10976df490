// SPDX-License-Identifier: MIT
// libsndfile, PortAudio and RtMidi stay inside io/src: what io shows names none of their types.
#include "knotwave/io/midi_file.h"
#include "knotwave/io/sound_file.h"

#if defined(SNDFILE_1) || defined(PORTAUDIO_H) || defined(RTMIDI_H)
#error "an audio library's header came along"
#endif
#ifdef KNOTWAVE_BAD
SNDFILE* file = nullptr;
#endif
