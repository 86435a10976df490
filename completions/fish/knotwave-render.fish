# Made by tools/program_pages.py from knotwave-render --help.

# Files with one of these endings, and folders.
function __knotwave_render_files
    set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
    string match -ri -- '^.*(?:/|\.(?:'(string join '|' $argv)'))$' $files
end

complete -c knotwave-render -f -a '(__knotwave_render_files toml mid rmi)'
complete -c knotwave-render -l version -d 'print the version and stop'
complete -c knotwave-render -s h -l help -d 'print this and stop'
complete -c knotwave-render -s o -l output -x -a '(__knotwave_render_files wav flac)' -d 'file to write: .wav or .flac by its ending; - writes headerless 32-bit float samples, interleaved, to standard output'
complete -c knotwave-render -l demo -x -a 'bwv846_prelude first-light groove pachelbel_canon petzold_minuet' -d 'play a built-in demo instead: bwv846_prelude, first-light, groove, pachelbel_canon, petzold_minuet'
complete -c knotwave-render -l journal -r -F -d 'play a recorded take again, with its own rate and seed: the same samples'
complete -c knotwave-render -l check -d 'read everything, render nothing; no output with it'
complete -c knotwave-render -l stems -x -a '(__fish_complete_directories (commandline -ct))' -d 'also write one file for each MIDI channel used, into this folder'
complete -c knotwave-render -l json -r -F -d 'write the report as JSON to a file, or to standard output (-)'
complete -c knotwave-render -s q -l quiet -d 'no progress and no warnings'
complete -c knotwave-render -l bits -x -a '16 24 32f' -d 'sample format: 16 or 24 bits, dithered, or 32-bit float (24 if not given)'
complete -c knotwave-render -l rate -x -d 'samples a second; FLAC holds 655350 at most (8000 to 768000; 48000 if not given)'
complete -c knotwave-render -l tail -x -a 'auto' -d 'how long to go on after the song\'s end: 0 to 3600 seconds, or auto: until silence, 30 s at most (auto if not given)'
complete -c knotwave-render -l max-length -x -d 'a longer song is refused (0 to 1000000000; 3600 if not given)'
complete -c knotwave-render -l seed -x -d 'seed of everything random (0 to 18446744073709551615; 1 if not given)'
complete -c knotwave-render -l block -x -d 'samples rendered at once; changes no sample (1 to 65536; 256 if not given)'
complete -c knotwave-render -l threads -x -d 'threads to render with; changes no sample (1 to 64; 1 if not given)'
complete -c knotwave-render -l simd -x -a 'best avx2 baseline' -d 'vector unit of the processor: the best it has, AVX2 and no wider, or what all of its kind have; changes no sample (best if not given)'
