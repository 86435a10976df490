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
complete -c knotwave-env -l midi-in -x -d 'part of a MIDI input\'s name; can be given again (if not given all but what knotwave-env sends)'
complete -c knotwave-env -l midi-out -x -d 'part of a MIDI output\'s name, for the first port of the patches; NAME=PORT for the port they call NAME'
complete -c knotwave-env -l cc -x -d 'send the first output of each PATCH to this controller (0 to 119)'
complete -c knotwave-env -l channel -x -d 'of every output, instead of the patch\'s (1 to 16)'
complete -c knotwave-env -l osc -x -d 'where OSC outputs go: a UDP port of this machine, or HOST:PORT'
complete -c knotwave-env -l cv -d 'control voltages go out as they are, with their direct current; without it loudspeakers are kept safe'
complete -c knotwave-env -l calibration -x -a '(__knotwave_env_files toml)' -d 'volts of the audio interface (.toml)'
complete -c knotwave-env -l audio-api -x -d 'for control voltage; jack, alsa, ..., as --list names them'
complete -c knotwave-env -l audio-device -x -d 'for control voltage: number in the list, or part of a name'
complete -c knotwave-env -l dry-run -x -d 'play this MIDI file instead of devices, as fast as can be'
complete -c knotwave-env -s o -l output -x -a '(__knotwave_env_files mid csv wav toml)' -d 'what --dry-run would send: as a .mid, one tick a sample of 1/48000 s; as a .csv; or the control voltages as a .wav; what --capture makes, as a .toml'
complete -c knotwave-env -l plot -x -d 'draw what --dry-run would send, or --capture heard, over the curves'
complete -c knotwave-env -l tail -x -d 'how long --dry-run plays on behind the end of the song (0 to 3600; 2 if not given)'
complete -c knotwave-env -l capture -x -d 'record this into a curve of few points instead of playing: cc0 to cc119, nrpn0 to nrpn16383, bend, pressure or poly_pressure, from MIDI inputs until Ctrl-C or --duration, or --from a file; loudness or peak of a sound file'
complete -c knotwave-env -l from -x -a '(__knotwave_env_files mid)' -d 'capture from this .mid, or this sound'
complete -c knotwave-env -l bits -x -a '7 14' -d 'of the controller or NRPN that is captured'
complete -c knotwave-env -l tolerance -x -d 'how far the curve may be from what was captured, in steps, or of sounds in dB with --floor, else of full scale; 0 takes half a step, 0.5 dB or 0.01 (0 to 10000; 0 if not given)'
complete -c knotwave-env -l points -x -d 'refuse a captured curve of more points than this; 0 takes any (0 to 4096; 0 if not given)'
complete -c knotwave-env -l beats -d 'times of the captured curve are beats: of the .mid, else of --bpm'
complete -c knotwave-env -l whole -d 'capture from the beginning to the end, not from the first move to the last'
complete -c knotwave-env -l ramp -x -d 'how long a captured value takes to one that is more than a step away (0.0001 to 10; 0.05 if not given)'
complete -c knotwave-env -l window -x -d 'what the loudness is taken over (0.0001 to 10; 0.05 if not given)'
complete -c knotwave-env -l hop -x -d 'from one loudness to the next, no longer than --window (0.0001 to 10; 0.01 if not given)'
complete -c knotwave-env -l floor -x -d 'loudness as dB from here, which is 0, to 0 dB, which is 1; 0: linear (-200 to 0; 0 if not given)'
