// SPDX-License-Identifier: MIT
// What a CLAP host says in a block, told to a plugin.
#pragma once
#include <clap/events.h>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

/// One event, `header.time` of this block. Of other spaces or kinds: nothing. [audio]
void add_clap_event(Plugin& plugin, const clap_event_header& header) KNOTWAVE_RT;
/// Only parameters, from the next block on. [any]
void set_clap_parameters(Plugin& plugin, const clap_input_events& events) KNOTWAVE_RT;
/// Tempo and place in the song from that sample on. [audio]
void add_clap_transport(Plugin& plugin, const clap_event_transport& transport,
                        std::int64_t sample) KNOTWAVE_RT;
/// At that sample of the block. [audio]
void give_clap_ends(std::span<const engine::EndedNote> notes, std::uint32_t sample,
                    const clap_output_events& out) KNOTWAVE_RT;
/// As MIDI of the host's first note port. [audio]
void give_clap_events(std::span<const base::MidiEvent> events,
                      const clap_output_events& out) KNOTWAVE_RT;

}  // namespace knotwave::plugins
