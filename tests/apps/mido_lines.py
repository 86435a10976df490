#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Prints the messages of a MIDI file as mido reads them: track, tick and bytes, a line each."""
import sys

import mido

for number, track in enumerate(mido.MidiFile(sys.argv[1]).tracks):
    tick = 0
    for message in track:
        tick += message.time
        if not message.is_meta:
            print(f"{number} {tick} {message.hex(sep='')}")
