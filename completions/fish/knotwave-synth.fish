# Made by tools/program_pages.py from knotwave-synth --help.

# Files with one of these endings, and folders.
function __knotwave_synth_files
    set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
    string match -ri -- '^.*(?:/|\.(?:'(string join '|' $argv)'))$' $files
end

complete -c knotwave-synth -f -a '(__knotwave_synth_files toml)'
complete -c knotwave-synth -l version -d 'print the version and stop'
complete -c knotwave-synth -s h -l help -d 'print this and stop'
complete -c knotwave-synth -l demo -x -a 'bwv846_prelude first-light groove pachelbel_canon petzold_minuet' -d 'play a built-in demo, its song and its patch: bwv846_prelude, first-light, groove, pachelbel_canon, petzold_minuet'
complete -c knotwave-synth -l song -x -a '(__knotwave_synth_files mid)' -d 'play this MIDI file (.mid) with PATCH, once, from the start'
complete -c knotwave-synth -l volume -x -d 'of everything, in dB (-96 to 24; 0 if not given)'
complete -c knotwave-synth -l threads -x -d 'threads to render with; changes no sample (1 to 64; 1 if not given)'
complete -c knotwave-synth -l seed -x -d 'seed of everything random (0 to 18446744073709551615; 1 if not given)'
complete -c knotwave-synth -l record -x -a '(__knotwave_synth_files wav flac)' -d 'record what is heard into this .wav or .flac, with .journal and .mid beside it, in place of older ones once it is whole; needs no sound device'
complete -c knotwave-synth -l duration -x -d 'end by itself after this time (0.001 to 1000000000)'
complete -c knotwave-synth -l list-devices -d 'print sound devices and MIDI ports, and stop'
complete -c knotwave-synth -l audio-api -x -d 'jack, alsa, ... as --list-devices names them, or none: no device, the clock alone (jack if not given and its server runs, else the system\'s own)'
complete -c knotwave-synth -l audio-device -x -d 'number in the list of devices, or part of a name'
complete -c knotwave-synth -l channels -x -d 'channels of the device that are played to (1,2 if not given)'
complete -c knotwave-synth -l rate -x -d 'samples a second; the device\'s own if not given (8000 to 768000)'
complete -c knotwave-synth -l block -x -d 'samples the device asks for at once; its own if not given (16 to 8192)'
complete -c knotwave-synth -l latency -x -d 'of the device, in milliseconds; the least it offers if not given (0.1 to 2000)'
complete -c knotwave-synth -l midi-api -x -d 'as --list-devices names them; all if not given'
complete -c knotwave-synth -l midi-in -x -d 'part of a MIDI input\'s name; can be given again (all if not given)'
complete -c knotwave-synth -l osc -x -d 'listen for OSC at this UDP port of this machine, or at HOST:PORT'
complete -c knotwave-synth -l midi-learn -r -F -d 'which controller moves what, kept in this file'
complete -c knotwave-synth -l plain -d 'a line a second, where something changed, instead of the page'
complete -c knotwave-synth -l json-status -d 'one JSON object a second on standard output, and no page'
complete -c knotwave-synth -l simd -x -a 'best avx2 baseline' -d 'vector unit of the processor: the best it has, AVX2 and no wider, or what all of its kind have; changes no sample (best if not given)'
