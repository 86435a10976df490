# Made by tools/program_pages.py from knotwave-curve --help.

# Files with one of these endings, and folders.
function __knotwave_curve_files
    set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
    string match -ri -- '^.*(?:/|\.(?:'(string join '|' $argv)'))$' $files
end

# FILE#NAME: the curves that FILE holds.
function __knotwave_curve_curves
    set -l word (commandline -ct)
    if not string match -q '*#*' -- $word
        __knotwave_curve_files $argv
        return
    end
    set -l file (string replace -r '#[^#]*$' '' -- $word)
    for name in (sed -nE 's/^ *\[(curves|surfaces)\.([A-Za-z0-9_-]+)\].*/\2/p' (string replace -r '^~/' $HOME/ -- $file) 2>/dev/null)
        echo $file#$name
    end
end

complete -c knotwave-curve -f
complete -c knotwave-curve -n __fish_use_subcommand -l version -d 'print the version and stop'
complete -c knotwave-curve -n __fish_use_subcommand -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n __fish_use_subcommand -a check -d 'read files of any kind and report their faults'
complete -c knotwave-curve -n __fish_use_subcommand -a info -d 'what a curve is: degree, knots, range, smoothness'
complete -c knotwave-curve -n __fish_use_subcommand -a eval -d 'a table of u, the coordinates, and their derivatives'
complete -c knotwave-curve -n __fish_use_subcommand -a plot -d 'a picture; without -o as text for the terminal'
complete -c knotwave-curve -n __fish_use_subcommand -a split -d 'one curve or surface into two, at a place'
complete -c knotwave-curve -n __fish_use_subcommand -a insert-knot -d 'more knots, the same curve or surface'
complete -c knotwave-curve -n __fish_use_subcommand -a elevate -d 'a higher degree, the same curve or surface'
complete -c knotwave-curve -n __fish_use_subcommand -a simplify -d 'fewer knots, and how far off it is at most'
complete -c knotwave-curve -n __fish_use_subcommand -a morph -d 'between two curves, however different they are'
complete -c knotwave-curve -n __fish_use_subcommand -a iso -d 'curves along a surface, where u or v stays'
complete -c knotwave-curve -n __fish_use_subcommand -a fit -d 'a curve near a table of numbers, or near a sound'
complete -c knotwave-curve -n __fish_use_subcommand -a import -d 'the paths of an SVG drawing as curves'
complete -c knotwave-curve -n __fish_use_subcommand -a export -d 'a curve as the path of an SVG drawing'
complete -c knotwave-curve -n '__fish_seen_subcommand_from check' -F
complete -c knotwave-curve -n '__fish_seen_subcommand_from check' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from info' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from info' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from info' -l json -d 'as JSON'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -l at -x -d 'parameters: U,U,... or, for a surface, U:V,U:V,...'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -l grid -x -d 'steps over the domain: one row more, both ends exact (1 to 1000000)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -l derivatives -x -d 'derivatives by u up to this order, from the right (0 to 15; 0 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from eval' -l json -d 'as JSON'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -s o -l output -x -a '(__knotwave_curve_files svg png)' -d 'file to write: .svg or .png by its ending'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -l size -x -d 'pixels, 200x200 to 8000x8000 (960x540 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -l columns -x -d 'width of the text picture (28 to 400; 72 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from plot' -l rows -x -d 'height of the text picture (6 to 200; 14 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -l at -x -d 'where: a parameter inside the domain'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -l direction -x -a 'u v' -d 'of a surface: along u or along v'
complete -c knotwave-curve -n '__fish_seen_subcommand_from split' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -l at -x -d 'where: U,U,... inside the domain'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -l times -x -d 'how often each (1 to 15; 1 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -l direction -x -a 'u v' -d 'of a surface: along u or along v'
complete -c knotwave-curve -n '__fish_seen_subcommand_from insert-knot' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -l times -x -d 'degrees more (1 to 14; 1 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -l direction -x -a 'u v' -d 'of a surface: along u or along v'
complete -c knotwave-curve -n '__fish_seen_subcommand_from elevate' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -l within -x -d 'decibels below the largest value (-240 to 0; -80 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -l degree -x -d 'lower the degree to this first (1 to 14)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from simplify' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from morph' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from morph' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from morph' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from morph' -l amount -x -d '0 is the first, 1 the second (0 to 1)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from morph' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -l u -x -d 'curves in v at these u'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -l v -x -d 'curves in u at these v'
complete -c knotwave-curve -n '__fish_seen_subcommand_from iso' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -f -a '(__knotwave_curve_files csv tsv txt wav flac)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -l within -x -d 'decibels below the largest value (-240 to 0; -80 if not given)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -l points -x -d 'exactly so many, as near as they can (2 to 4096)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -l degree -x -d 'of the curve: 3 if not given (1 to 15)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from fit' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -F
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -s o -l output -x -a '(__knotwave_curve_files toml)' -d 'file to write (.toml); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -l path -x -d 'only the path with this id'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -l down -d 'keep y as it is: downwards'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -l unit-square -d 'stretch each curve onto 0 to 1 in x and in y'
complete -c knotwave-curve -n '__fish_seen_subcommand_from import' -l name -x -d 'name of the result'
complete -c knotwave-curve -n '__fish_seen_subcommand_from export' -f -a '(__knotwave_curve_curves toml)'
complete -c knotwave-curve -n '__fish_seen_subcommand_from export' -s h -l help -d 'print this and stop'
complete -c knotwave-curve -n '__fish_seen_subcommand_from export' -s o -l output -x -a '(__knotwave_curve_files svg)' -d 'file to write (.svg); the terminal if not given'
complete -c knotwave-curve -n '__fish_seen_subcommand_from export' -l within -x -d 'decibels below the largest value (-240 to 0; -80 if not given)'
