#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""program_pages_test.py SOURCE_DIR BIN_DIR PROGRAM...: manual pages and completions are what tools/program_pages.py
makes of these programs; the pages are clean to mandoc, and bash, zsh and fish complete by them."""
import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

SOURCE, BIN, NAMES = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sorted(sys.argv[3:])
sys.path.insert(0, str(SOURCE / "tools"))
sys.dont_write_bytecode = True
from program_help import read_help  # noqa: E402
from program_pages import pages_of  # noqa: E402

failures = []
CURVES = 'format = 1\nkind = "curve"\n[curves.decay60]\npoints = [1, 0]\n[curves.decay_slow]\n[surfaces.hill]\n'
FILES = {"my song.mid": "", "notes.MID": "", "bell.toml": CURVES, "sounds/x.wav": "", "readme.txt": ""}
# What is typed, and all that it may become. A word that ends here has one possibility and a space behind it.
CASES = {
    "knotwave-render --bi": {"--bits"},
    "knotwave-render --bits ": {"16", "24", "32f"},
    "knotwave-render --bits 3": {"32f"},
    "knotwave-render --simd a": {"avx2"},
    "knotwave-render --tail a": {"auto"},
    "knotwave-render --demo p": {"pachelbel_canon", "petzold_minuet"},
    "knotwave-render --stems s": {"sounds"},
    "knotwave-render bell.toml no": {"notes.MID"},
    "knotwave-render --rate ": set(),
    "knotwave-synth be": {"bell.toml"},
    "knotwave-env be": {"bell.toml"},
    "knotwave-env --cali": {"--calibration"},
    "knotwave-synth --midi-l": {"--midi-learn"},
    "knotwave-curve ev": {"eval"},
    "knotwave-curve in": {"info", "insert-knot"},
    "knotwave-curve eval --gr": {"--grid"},
    "knotwave-curve split --direction ": {"u", "v"},
    "knotwave-curve split bell.toml -o be": {"bell.toml"},
    "knotwave-curve plot be": {"bell.toml"},
    "knotwave-curve plot bell.toml#decay": {"bell.toml#decay60", "bell.toml#decay_slow"},
    "knotwave-curve eval bell.toml#h": {"bell.toml#hill"},
    "knotwave-curve check re": {"readme.txt"},
    "knotwave-curve fit re": {"readme.txt"},
    "knotwave-curve fit be": set(),
}


def expect(what, seen, wanted):
    if seen != wanted:
        failures.append(f"{what}\n  seen:     {seen}\n  expected: {wanted}")


def committed_pages_are_new():
    pages = pages_of(BIN, NAMES)
    there = {str(path.relative_to(SOURCE)) for folder in ("docs/man", "completions") for path in (SOURCE / folder).rglob("*")
             if path.is_file()}
    stale = sorted(there - set(pages)) + [path for path, text in pages.items()
                                          if path not in there or (SOURCE / path).read_text() != text]
    if stale:
        failures.append("not what the programs say now: " + ", ".join(stale) +
                        f"\n  made anew by: tools/program_pages.py {os.path.relpath(BIN, SOURCE)}")


def pages_are_clean():
    for name in NAMES:
        page = SOURCE / f"docs/man/{name}.1"
        said = subprocess.run(["mandoc", "-T", "lint", page], capture_output=True, text=True).stdout.splitlines()
        faults = [line for line in said if 'missing date, using ""' not in line]  # pages carry a version and no date
        shown = re.sub(".\b", "", subprocess.run(["mandoc", "-T", "utf8", page], capture_output=True, text=True).stdout)
        if faults or "SYNOPSIS" not in shown:
            failures.append(f"{page.name}: {faults}")


def typed_words(line):
    """As readline splits: at blanks, and = is a word of its own."""
    return line.replace("=", " = ").split(" ") if "=" in line else line.split(" ")


def bash_offers(line, folder):
    program = line.split()[0]
    words = typed_words(line)
    script = f'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _{program.replace("-", "_")}; printf "%s\\n" "${{COMPREPLY[@]}}"'
    said = subprocess.run(["bash", "--norc", "-c", script, "bash", SOURCE / "completions/bash" / program, *words], cwd=folder,
                          capture_output=True, text=True)
    expect(f"bash: {line!r}, errors", said.stderr, "")
    return set(said.stdout.split("\n")) - {""}


def fish_offers(line, folder):
    program = line.split()[0]
    script = f"source {SOURCE}/completions/fish/{program}.fish; complete -C $argv[1]"
    said = subprocess.run(["fish", "--no-config", "-c", script, line], cwd=folder, capture_output=True, text=True)
    expect(f"fish: {line!r}, errors", said.stderr, "")
    return {offer.split("\t")[0].rstrip("/") for offer in said.stdout.splitlines()}


def every_option_is_offered(folder):
    for name in NAMES:
        help = read_help(BIN / name)
        for part in [help, *help.children]:
            wanted = {option for one in part.options for option in one.names if option.startswith("--")}
            for shell, offers in (("bash", bash_offers), ("fish", fish_offers)):
                expect(f"{shell}: options of {part.name}", {o for o in offers(f"{part.name} --", folder) if o.startswith("--")}, wanted)


def typed_in(argv, environment, begin, lines, folder, done):
    """Types each line and a tab into a shell on a terminal; what the line is then, for each."""
    master, slave = pty.openpty()
    shell = subprocess.Popen(argv, stdin=slave, stdout=slave, stderr=slave, cwd=folder, env=environment, start_new_session=True)
    os.close(slave)
    said = bytearray()

    def drain():
        try:
            while block := os.read(master, 4096):
                said.extend(block)
        except OSError:
            pass  # the shell has gone
    threading.Thread(target=drain, daemon=True).start()

    def wait(count):
        end = time.monotonic() + 60
        while not done.exists() or len(done.read_text().splitlines()) < count:
            if time.monotonic() > end:
                failures.append(f"{argv[0]} does not answer: {said.decode(errors='replace')}")
                return False
            time.sleep(0.02)
        return True
    os.write(master, f"{begin}; echo begun >>{done}\n".encode())
    if wait(1):
        for i, line in enumerate(lines, 2):
            os.write(master, f"\x15{line}\t\x18w".encode())
            if not wait(i):
                break
    shell.kill()
    shell.wait()
    os.close(master)
    return done.read_text().splitlines()[1:] if done.exists() else []


def tab_completes(folder, work):
    """On a terminal, where one completion is left: as a user sees it."""
    lines = [line for line, offers in CASES.items() if len(offers) == 1] + ["knotwave-render bell.toml my"]
    wanted = [f"{line.rpartition(' ')[0]} {next(iter(offers))}" for line, offers in CASES.items() if len(offers) == 1]
    wanted += [r"knotwave-render bell.toml my\ song.mid"]
    environment = {"PATH": os.environ["PATH"], "HOME": str(work), "TERM": "vt100", "LC_ALL": "C.UTF-8"}
    files = " ".join(f"'{SOURCE}/completions/bash/{name}'" for name in NAMES)
    bash = f"for file in {files}; do source $file; done; bind -x '\"\\C-xw\": printf \"%s\\n\" \"$READLINE_LINE\" >>{work}/bash'"
    zsh = (f"fpath=('{SOURCE}/completions/zsh' $fpath); autoload -Uz compinit; compinit -u -D; "
           f"keep() {{ print -r -- $BUFFER >>{work}/zsh }}; zle -N keep; bindkey -e; bindkey '^Xw' keep; zmodload zsh/complist")
    for argv, begin in ((["bash", "--norc", "--noprofile", "-i"], bash), (["zsh", "-d", "-f", "-i"], zsh)):
        seen = typed_in(argv, environment, begin, lines, folder, work / argv[0])
        expect(f"{argv[0]} on a terminal", [line.rstrip(" /").replace(r"\#", "#") for line in seen], wanted)


def main():
    missing = [tool for tool in ("mandoc", "bash", "zsh", "fish") if not shutil.which(tool)]
    if missing:
        sys.exit(f"missing: {' '.join(missing)} (Debian: packages of these names)")
    committed_pages_are_new()
    pages_are_clean()
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        folder = work / "files"
        for name, text in FILES.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        for line, offers in CASES.items():
            expect(f"bash: {line!r}", {offer.rstrip("/") for offer in bash_offers(line, folder)}, offers)
            expect(f"fish: {line!r}", fish_offers(line, folder), offers)
        expect("bash: --bits=3", bash_offers("knotwave-render --bits=3", folder), {"32f"})
        every_option_is_offered(folder)
        tab_completes(folder, work)
    for failure in failures:
        print(failure)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
