#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""lint.py SOURCE_DIR BUILD_DIR CLANG_TIDY all|changed|PLACE...

clang-tidy over the sources that the build compiles: all of them, those that the last commit and the working
tree touched, or those at and below places. One process a core. What passed is remembered in BUILD_DIR/lint by the
contents of the source, of every header of ours it includes, of its command and of .clang-tidy, so a run that
was broken off goes on where it stopped, and a second one takes a moment.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys


def text_of(*command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else ""


# What `changed` looks at: the rooms where clang-tidy has nothing to say. It may only grow.
CLEAN = ("apps/", "base/", "examples/", "io/")


def sources(root, build):
    """path below root -> its entry in the compile commands. What must not compile is left out."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"]).resolve()
        if root not in path.parents or build in path.parents:
            continue
        name = str(path.relative_to(root))
        if not name.startswith("tests/compile_fail/"):
            found[name] = entry
    return found


def chosen(names, words, root):
    if words == ["all"]:
        return names
    if words == ["changed"]:
        touched = text_of("git", "diff", "--name-only", "--diff-filter=d", "HEAD~1", folder=root)
        touched += text_of("git", "ls-files", "--others", "--exclude-standard", folder=root)
        return [name for name in names if name in touched.split() and name.startswith(CLEAN)]
    return [name for name in names if any(name == word or name.startswith(word.rstrip("/") + "/") for word in words)]


def included(build):
    """object -> the files it was made from, as ninja knows them; nothing without ninja."""
    found, files = {}, []
    for line in text_of("ninja", "-t", "deps", folder=build).splitlines():
        if head := re.match(r"(\S+): #deps", line):
            files = found.setdefault(head[1], [])
        elif line.strip():
            files.append(line.strip())
    return found


def key_of(entry, files, root, build, rules):
    """None if what the source includes is not known: then it is looked at each time."""
    if not files:
        return None
    digest = hashlib.sha256(rules + entry["command"].encode())
    for file in sorted({(build / file).resolve() for file in files + [entry["file"]]}):
        if root in file.parents:
            digest.update(str(file.relative_to(root)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def main():
    root, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    tidy, words = sys.argv[3], sys.argv[4:]
    entries = sources(root, build)
    names = sorted(chosen(list(entries), words, root))
    passed = build / "lint"
    passed.mkdir(exist_ok=True)
    rules = (root / ".clang-tidy").read_bytes() + text_of(tidy, "--version", folder=root).encode()
    files = included(build)

    def look_at(name):
        entry = entries[name]
        made = re.search(r" -o (\S+)", entry["command"])
        key = key_of(entry, files.get(made[1]) if made else None, root, build, rules)
        if key and (passed / key).exists():
            return name, "known", ""
        # The commands may be gcc's, with warnings clang does not know.
        done = subprocess.run([tidy, "-p", build, "--quiet", "--extra-arg=-Wno-unknown-warning-option",
                               root / name], capture_output=True, text=True)
        if done.returncode == 0 and key:
            (passed / key).touch()
        return name, "clean" if done.returncode == 0 else "faulty", done.stdout

    count = {"known": 0, "clean": 0, "faulty": 0}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, state, output in pool.map(look_at, names):
            count[state] += 1
            if state == "faulty":
                print(f"{name}:\n{output}", flush=True)
    print(f"{len(names)} sources: {count['known']} passed before, {count['clean']} pass, {count['faulty']} do not")
    return 1 if count["faulty"] else 0


sys.exit(main())
