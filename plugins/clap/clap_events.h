// SPDX-License-Identifier: MIT
// What a CLAP host says in a block, told to the instrument.
#pragma once
#include <clap/events.h>

#include "knotwave/plugins/instrument.h"

namespace knotwave::plugins {

/// One event, `header.time` of this block. Of other spaces or kinds: nothing. [audio]
void add_clap_event(Instrument& instrument, const clap_event_header& header) KNOTWAVE_RT;
/// Only parameters, from the next block on. [any]
void set_clap_parameters(Instrument& instrument, const clap_input_events& events) KNOTWAVE_RT;
/// Tempo and place in the song from that sample on. [audio]
void add_clap_transport(Instrument& instrument, const clap_event_transport& transport,
                        std::int64_t sample) KNOTWAVE_RT;

}  // namespace knotwave::plugins
