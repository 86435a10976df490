# Made by tools/program_pages.py from knotwave-env --help.

# Files with one of these endings, and folders.
function __knotwave_env_files
    set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
    string match -ri -- '^.*(?:/|\.(?:'(string join '|' $argv)'))$' $files
end

complete -c knotwave-env -f -a '(__knotwave_env_files toml)'
complete -c knotwave-env -l version -d 'print the version and stop'
complete -c knotwave-env -s h -l help -d 'print this and stop'
complete -c knotwave-env -l thru -d 'send on all that comes in, merged, to the first port'
complete -c knotwave-env -l latency -x -d 'from what comes in to what goes out, in milliseconds (1 to 1000; 2 if not given)'
complete -c knotwave-env -l bpm -x -d 'tempo until a clock or a score says another (4 to 1000; 120 if not given)'
complete -c knotwave-env -l seed -x -d 'seed of everything random (0 to 18446744073709551615; 1 if not given)'
complete -c knotwave-env -l duration -x -d 'end by itself after this time (0.001 to 1000000000)'
complete -c knotwave-env -l monitor -d 'print every message that goes out'
complete -c knotwave-env -l quiet -d 'no status lines'
complete -c knotwave-env -l list -d 'print MIDI inputs and outputs and sound devices, and stop'
complete -c knotwave-env -l midi-api -x -d 'as --list names them; all if not given'
complete -c knotwave-env -l midi-in -x -d 'part of a MIDI input\'s name; can be given again (all if not given)'
complete -c knotwave-env -l midi-out -x -d 'part of a MIDI output\'s name, for the first port of the patches; NAME=PORT for the port they call NAME'
complete -c knotwave-env -l cc -x -d 'send the first output of each PATCH to this controller (0 to 119)'
complete -c knotwave-env -l channel -x -d 'of every output, instead of the patch\'s (1 to 16)'
complete -c knotwave-env -l osc -x -d 'where OSC outputs go: a UDP port of this machine, or HOST:PORT'
complete -c knotwave-env -l cv -d 'control voltages go out as they are, with their direct current; without it loudspeakers are kept safe'
complete -c knotwave-env -l calibration -x -a '(__knotwave_env_files toml)' -d 'volts of the audio interface (.toml)'
complete -c knotwave-env -l audio-api -x -d 'for control voltage; jack, alsa, ..., as --list names them'
complete -c knotwave-env -l audio-device -x -d 'for control voltage: number in the list, or part of a name'
complete -c knotwave-env -l dry-run -x -d 'play this MIDI file instead of devices, as fast as can be'
complete -c knotwave-env -s o -l output -x -a '(__knotwave_env_files mid csv wav)' -d 'what --dry-run would send: as a .mid, one tick a sample of 1/48000 s; as a .csv; or the control voltages as a .wav'
complete -c knotwave-env -l plot -x -d 'draw what --dry-run would send, as steps over the curves'
complete -c knotwave-env -l tail -x -d 'how long --dry-run plays on behind the end of the song (0 to 3600; 2 if not given)'
