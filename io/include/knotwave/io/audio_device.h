// SPDX-License-Identifier: MIT
// Sound devices: what there is, and a stream that asks for block after block. Two ways behind one
// interface: JACK itself (also PipeWire's), with sample-accurate MIDI, and PortAudio for the rest.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"

namespace knotwave::io {

struct AudioDeviceInfo {
  int number = 0;   ///< as list_audio_devices() counts, from 0; changes when devices come and go
  std::string api;  ///< "jack", or PortAudio's host API in lower case: "alsa", "oss"
  std::string name;
  int outputs = 0;
  double rate_hz = 0;    ///< its own
  double latency_s = 0;  ///< the least it offers
  bool is_default = false;
};

struct AudioDeviceList {
  std::vector<AudioDeviceInfo> devices;
  std::vector<std::string> notes;  ///< why an API has none: "jack: no server is running"
};

/// [control] May take a second, and 8 s where a server hangs, which becomes a note. What the
/// libraries below would print is kept off standard error: while PortAudio looks around, a quarter
/// of a second, what other threads of the program print there is lost as well.
AudioDeviceList list_audio_devices();

struct AudioConfig {
  /// As in AudioDeviceInfo; empty: "jack" where a server runs, else PortAudio. "none": no device,
  /// blocks are asked for at the pace of the clock. "portaudio-jack": JACK through PortAudio, which
  /// the list leaves out.
  std::string api;
  std::string device;  ///< a number of the list, or part of a name in any case; empty: the default
  double rate_hz = 0;  ///< 8000..768000; 0: the device's own ("none": 48000)
  int block_frames = 0;  ///< 16..8192; 0: the device's own ("none": 256)
  double latency_s = 0;  ///< PortAudio: asked for; 0: the least the device offers
  /// Device channel, 1..256, of each channel of the client; none twice.
  std::vector<int> channels = {1, 2};
  std::string client_name = "Knotwave";
  bool connect = true;  ///< jack: to the physical outputs
};

inline constexpr int kMaxAudioBlock = 8192;

/// One block to be filled.
struct AudioBlock {
  /// Frames since the first block; jumps over what the device skipped, where it tells (PortAudio
  /// does not). Goes on after stop() and start().
  std::int64_t frame = 0;
  /// steady_clock_ns() when the device asked for it; never goes back. "none": when the block was
  /// due, so exactly regular.
  std::int64_t time_ns = 0;
  std::span<float* const> outputs;  ///< [channels][frames], to be overwritten
  int frames = 0;                   ///< 1..kMaxAudioBlock, not the same every time
  /// Of the stream's own MIDI port, where it has one (jack): time.sample is the offset in this
  /// block. In order. System exclusive data is valid during the call.
  std::span<const base::MidiEvent> midi;
};

class AudioClient {
 public:
  virtual ~AudioClient() = default;
  /// Fills every sample of every output. [audio]
  virtual void process(const AudioBlock& block) KNOTWAVE_RT = 0;
};

/// What was agreed on. Block size, latency and is_freewheeling follow the server: they are as of
/// the last status().
struct AudioFormat {
  std::string api;
  std::string device;       ///< jack without a connection: "not connected"
  std::string client_name;  ///< jack: as the server gave it, ours may have been taken
  double rate_hz = 0;
  int block_frames = 0;  ///< most often
  int channels = 0;
  double latency_s = 0;  ///< of the output as the device tells it; negative: it tells nonsense
  bool has_midi = false;
  bool is_freewheeling = false;
};

struct AudioStatus {
  enum class State { stopped, running, lost };
  State state = State::stopped;
  std::string reason;  ///< of lost: "the JACK server has gone", "no block for 0.8 s"
  std::int64_t blocks = 0;
  std::int64_t xruns = 0;     ///< as the device counts them
  std::int64_t overruns = 0;  ///< blocks whose process() took longer than they last
  /// Messages of the stream's MIDI port that were not complete ones.
  std::int64_t midi_dropped = 0;
  /// Who is connected to that port, by JACK's names: "a2j:Keystep".
  std::vector<std::string> midi_sources;
  double load = 0;  ///< share of the deadline process() takes, smoothed over 1 s
  /// Since open(); p99 is rounded up, by 1 % of the deadline at most.
  double load_p99 = 0, load_max = 0;
};

/// Open from open() to the destructor. [control] unless said otherwise. Of one thread.
class AudioStream {
 public:
  /// `client` must outlive the stream. Errors: unknown_name (no such API or device: the message
  /// lists what there is), unsupported (no device at all, an API that is not built in, a rate or
  /// block the device refuses; the message says what to do), value_out_of_range, io_failed.
  static Result<std::unique_ptr<AudioStream>> open(const AudioConfig& config, AudioClient& client);
  /// Stops first. Returns within 1 s even where the device's library hangs (its stream is then left
  /// behind, and is_poisoned() says so).
  virtual ~AudioStream() = default;

  /// Errors: io_failed, with what the device says.
  virtual Result<void> start() = 0;
  /// No process() after it returns, within 1 s.
  virtual void stop() = 0;
  virtual const AudioFormat& format() const = 0;
  /// Looks whether the device still lives: call it some ten times a second. Lost is told within 1 s
  /// (blocks longer than 0.2 s: within four of them) and stays: open another stream.
  virtual AudioStatus status() = 0;
  /// jack, once it was started: connects ports of others that send MIDI, by JACK's names, to the
  /// stream's own port, so that they are heard exact to the sample. Call it with all of them some
  /// ten times a second: each is connected when it comes, once; who takes that connection away
  /// keeps it so until that port goes and comes again. AudioStatus::midi_sources tells who is
  /// connected. Elsewhere this does nothing.
  virtual void connect_midi(const std::vector<std::string>& sources);

  /// A library hung, as PortAudio does when a JACK server dies, and has not come back: it cannot be
  /// used in this process, start the program anew. The thread that hangs in it is left behind and
  /// keeps no exit() from ending the program. [any]
  static bool is_poisoned() noexcept;
};

/// Nanoseconds of the clock that AudioBlock and MIDI inputs are stamped with. [any]
std::int64_t steady_clock_ns() KNOTWAVE_RT;

}  // namespace knotwave::io
