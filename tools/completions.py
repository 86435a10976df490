# SPDX-License-Identifier: MIT
"""A Help (program_help.py) as completions for bash, zsh and fish, which need nothing but the shell and sed."""
import re

MADE_BY = "# Made by tools/program_pages.py from {} --help."
# The headings of a curve file, as [curves.NAME].
CURVE_NAMES = r"s/^ *\[(curves|surfaces)\.([A-Za-z0-9_-]+)\].*/\2/p"


def commands_of(help):
    """The program itself, or each of its commands: (name, Help)."""
    return [("", help), *((child.name.split()[1], child) for child in help.children)]


def positional_place(help):
    """One place for all positionals of a command, for shells that do not count them."""
    places = [positional.place for positional in help.positionals if positional.place.is_file]
    if not places:
        return None
    union = places[0]
    for place in places[1:]:
        union.endings = union.endings + place.endings if union.endings and place.endings else []
        union.is_curve |= place.is_curve
    return union


def filled(template, **values):
    for name, value in values.items():
        template = template.replace(f"@{name}@", value)
    return template


# --- bash

BASH = r"""@made_by@

# The word so far is $cur. Files with one of these endings, or any, and folders.
@function@_files() {
  local file word=${cur//\\/} ending
  word=${word#[\"\']}
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [ $# -eq 0 ] || [ -d "${file/#\~\//$HOME/}" ]; then COMPREPLY+=("$file"); continue; fi
    for ending in "$@"; do
      case ${file,,} in *."$ending") COMPREPLY+=("$file") ;; esac
    done
  done < <(compgen -f -- "$word")
}

@curves@@function@_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

@function@() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}@declare@
  COMPREPLY=()
  if [ "$cur" = = ]; then cur=; elif [ "$prev" = = ]; then prev=${COMP_WORDS[COMP_CWORD - 2]}; fi
@body@
}
complete -F @function@ @program@
"""

BASH_CURVES = r"""# FILE#NAME: the curves that FILE holds.
@function@_curves() {
  local name file=${cur//\\/}
  file=${file#[\"\']}
  case $file in
    *\#*) ;;
    *) @function@_files "$@"; return ;;
  esac
  local prefix=${file##*\#}
  file=${file%\#*}
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do
    case $name in "$prefix"*) COMPREPLY+=("$file#$name") ;; esac
  done < <(sed -nE '@sed@' "${file/#\~\//$HOME/}" 2>/dev/null)
}

"""


def bash_place(function, place):
    """What completes a place, as a command; empty for what cannot be known."""
    if place is None:
        return ""
    if place.words:
        return f'{function}_words "{" ".join(place.words)}"'
    if place.is_folder:
        return "compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- \"$cur\")"
    if place.is_curve or place.is_file:
        kind = "curves" if place.is_curve else "files"
        return " ".join([f"{function}_{kind}", *place.endings])
    return ""


def bash_command(function, help):
    lines = []
    cases = {}
    for option in help.options:
        if option.type:
            cases.setdefault(bash_place(function, option.place), []).extend(option.names)
    if cases:
        lines.append("case $prev in")
        for action, names in cases.items():
            lines.append(f"  {' | '.join(names)}) {action + '; ' if action else ''}return ;;")
        lines.append("esac")
    names = " ".join(name for option in help.options for name in option.names)
    rest = bash_place(function, positional_place(help))
    if help.commands:
        rest = f'{function}_words "{" ".join(name for name, _ in help.commands)}"'
    lines.append("case $cur in")
    lines.append(f'  -*) {function}_words "{names}" ;;')
    if rest:
        lines.append(f"  *) {rest} ;;")
    lines.append("esac")
    return lines


def bash_completion(help):
    function = "_" + help.name.replace("-", "_")
    body = bash_command(function, help)
    if help.commands:
        top = body
        body = ['for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do',
                '  case $word in -*) ;; *) command=$word; break ;; esac', "done", "case $command in"]
        body += ["  '')", *(f"    {line}" for line in top), "    ;;"]
        for name, child in commands_of(help)[1:]:
            body += [f"  {name})", *(f"    {line}" for line in bash_command(function, child)), "    ;;"]
        body += ["esac"]
    has_curves = any("_curves" in line for line in body)
    return filled(BASH, made_by=MADE_BY.format(help.name), curves=BASH_CURVES if has_curves else "",
                  declare=" command='' word" if help.commands else "", body="\n".join(f"  {line}" for line in body),
                  function=function, program=help.name, sed=CURVE_NAMES)


# --- zsh

ZSH_CURVES = r"""# FILE#NAME: the curves that FILE holds.
@function@_curves() {
  if [[ $PREFIX != *\#* ]]; then
    _files -g '(#i)*.toml'
    return
  fi
  local file=${${(Q)PREFIX%\#*}/#\~\//$HOME/}
  local -a names=(${(f)"$(sed -nE '@sed@' $file 2>/dev/null)"})
  compset -P '*\#'
  compadd -a names
}

"""


def zsh_quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def zsh_about(text):
    return re.sub(r"([\[\]:\\])", r"\\\1", text)


def zsh_any(endings):
    """(wav|flac); one in brackets would be taken for a qualifier."""
    return f"({'|'.join(endings)})" if len(endings) > 1 else endings[0]


def zsh_place(function, place):
    if place.words:
        return f"({' '.join(place.words)})"
    if place.is_folder:
        return "_files -/"
    if place.is_curve:
        return f"{function}_curves"
    if place.is_file and place.endings:
        return f'_files -g "(#i)*.{zsh_any(place.endings)}"'
    return "_files" if place.is_file else " "


def zsh_arguments(function, help):
    for option in help.options:
        about = zsh_about(option.about)
        action = f":{zsh_about(option.type)}:{zsh_place(function, option.place)}" if option.type else ""
        if len(option.names) > 1:
            given = f"'({' '.join(option.names)})'{{{','.join(option.names)}}}"  # either, once
            yield given + zsh_quoted(f"[{about}]{action}")
        else:
            times = "*" if "given again" in option.about else ""
            yield zsh_quoted(f"{times}{option.names[0]}[{about}]{action}")
    if help.commands:
        yield "'1: :->command'"
        yield "'*:: :->words'"
    for i, positional in enumerate(help.positionals, 1):
        place = "*" if positional.is_many or "two" in positional.about else str(i)
        yield zsh_quoted(f"{place}:{zsh_about(positional.name)}:{zsh_place(function, positional.place)}")


def zsh_call(function, help, indent, flags="-s"):
    return f"_arguments {flags} \\\n" + " \\\n".join(f"{indent}  {line}" for line in zsh_arguments(function, help))


def zsh_completion(help):
    function = f"_{help.name}"
    if not help.commands:
        body = "  " + zsh_call(function, help, "  ") + "\n"
    else:
        body = "  local curcontext=$curcontext state line\n  local -A opt_args\n"
        body += "  " + zsh_call(function, help, "  ", "-C") + " && return\n  case $state in\n    command)\n"
        body += "      local -a commands=(\n"
        body += "".join(f"        {zsh_quoted(name + ':' + zsh_about(about))}\n" for name, about in help.commands)
        body += "      )\n      _describe command commands\n      ;;\n    words)\n      case $line[1] in\n"
        for name, child in commands_of(help)[1:]:
            body += f"        {name})\n          " + zsh_call(function, child, "          ") + "\n          ;;\n"
        body += "      esac\n      ;;\n  esac\n"
    curves = ZSH_CURVES if f"{function}_curves" in body else ""
    return filled("#compdef @program@\n@made_by@\n\n" + curves + "@function@() {\n" + body + '}\n\n@function@ "$@"\n',
                  made_by=MADE_BY.format(help.name), function=function, program=help.name, sed=CURVE_NAMES)


# --- fish

FISH_FILES = r"""# Files with one of these endings, and folders.
function @function@_files
    set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
    string match -ri -- '^.*(?:/|\.(?:'(string join '|' $argv)'))$' $files
end

"""

FISH_CURVES = r"""# FILE#NAME: the curves that FILE holds.
function @function@_curves
    set -l word (commandline -ct)
    if not string match -q '*#*' -- $word
        @function@_files $argv
        return
    end
    set -l file (string replace -r '#[^#]*$' '' -- $word)
    for name in (sed -nE '@sed@' (string replace -r '^~/' $HOME/ -- $file) 2>/dev/null)
        echo $file#$name
    end
end

"""


def fish_quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish_place(function, place):
    if place.words:
        return f" -x -a {fish_quoted(' '.join(place.words))}"
    if place.is_folder:
        return " -x -a '(__fish_complete_directories (commandline -ct))'"
    if place.is_curve or (place.is_file and place.endings):
        kind = "curves" if place.is_curve else "files"
        return f" -x -a '({function}_{kind} {' '.join(place.endings)})'"
    return " -r -F" if place.is_file else " -x"


def fish_command(function, program, condition, help):
    start = f"complete -c {program}{condition}"
    place = positional_place(help)
    if place is not None:
        yield start + (fish_place(function, place).replace(" -x", " -f").replace(" -r", ""))
    for option in help.options:
        names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in option.names)
        arguments = fish_place(function, option.place) if option.type else ""
        yield f"{start} {names}{arguments} -d {fish_quoted(option.about)}"


def fish_completion(help):
    function = "__" + help.name.replace("-", "_")
    lines = []
    if not help.commands:
        lines += fish_command(function, help.name, "", help)
    else:
        lines += [f"complete -c {help.name} -f"]
        lines += fish_command(function, help.name, " -n __fish_use_subcommand", help)
        for name, about in help.commands:
            lines.append(f"complete -c {help.name} -n __fish_use_subcommand -a {name} -d {fish_quoted(about)}")
        for name, child in commands_of(help)[1:]:
            lines += fish_command(function, help.name, f" -n '__fish_seen_subcommand_from {name}'", child)
    body = "\n".join(lines)
    parts = FISH_FILES if f"({function}_files" in body or f"({function}_curves" in body else ""
    parts += FISH_CURVES if f"({function}_curves" in body else ""
    return filled("@made_by@\n\n" + parts + body + "\n", made_by=MADE_BY.format(help.name), function=function,
                  sed=CURVE_NAMES)
