# SPDX-License-Identifier: MIT
"""Reads what our programs print for --help (apps/command_line/options.cpp lays it out) into plain objects."""
import re
import subprocess
from dataclasses import dataclass, field

COLUMN = 26  # where the help begins to say what a name means: kNameColumns of options.cpp
FILE_TYPES = {"FILE", "PATCH", "SCORE"}


@dataclass
class Place:
    """What can stand at a place of the command line."""
    words: list = field(default_factory=list)
    endings: list = field(default_factory=list)  # of file names; none = any file
    is_file: bool = False
    is_folder: bool = False
    is_curve: bool = False  # FILE#NAME

    def __str__(self):
        return "|".join(self.words) or ("FILE" if self.is_file else "DIR" if self.is_folder else "NAME")


@dataclass
class Option:
    names: list  # short first
    type: str    # empty for a flag
    about: str

    @property
    def place(self):
        return place_of(self.type, self.about)


@dataclass
class Positional:
    name: str
    about: str
    is_many: bool

    @property
    def place(self):
        return place_of(self.name, self.about)


@dataclass
class Help:
    name: str  # of the program, or "program command"
    about: str
    usage: str
    positionals: list
    options: list
    commands: list  # of (name, about)
    notes: list  # of lines: what stands below the options
    children: list = field(default_factory=list)  # Help of each command


def place_of(kind, about):
    """From "16|24|32f", "FILE|-", "auto|SECONDS", and from the endings or names that the text lists."""
    parts = kind.split("|")
    place = Place(words=[part for part in parts if re.fullmatch(r"[a-z0-9][a-z0-9.-]*", part)])
    place.is_folder = "DIR" in parts
    place.is_file = bool(FILE_TYPES & set(parts))
    place.is_curve = place.is_file and "FILE#NAME" in about
    if place.is_file:
        place.endings = re.findall(r"(?<![\w.])\.([a-z]+)\b", about.partition(", with ")[0]) or (["toml"] if place.is_curve else [])
    listed = re.search(r": ([a-z0-9_-]+(?:, [a-z0-9_-]+)+)$", about)
    if kind == "NAME" and listed:
        place.words = listed[1].split(", ")
    return place


def items_of(lines):
    """[(names, about)] from lines of two columns; a long name stands on a line of its own."""
    items = []
    for line in lines:
        names, about = (line[:COLUMN], line[COLUMN:]) if line[COLUMN - 1:COLUMN] in ("", " ") else (line, "")
        if line[2] != " ":
            items.append([names.strip(), about])
        else:
            items[-1][1] = f"{items[-1][1]} {about}".strip()
    return items


def read_help(program, command=None):
    words = [command] if command else []
    text = subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    about = " ".join(lines[:at])
    usage = re.sub(r"\(\d+x\)", "", lines[at].removeprefix("Usage: ")).replace("[SUBCOMMAND]", "COMMAND ...")
    found = {"Positionals": [], "Options": [], "Subcommands": []}
    at += 1
    while at < len(lines):
        if not lines[at]:
            at += 1
            continue
        title, body = lines[at].removesuffix(":"), []
        while at + 1 + len(body) < len(lines) and lines[at + 1 + len(body)].startswith("  "):
            body.append(lines[at + 1 + len(body)])
        if title not in found and not (body and body[0].startswith("  -")):
            break
        found["Options" if title not in found else title] += items_of(body)
        at += 1 + len(body)
    options = []
    for names, meaning in found["Options"]:
        names, _, kind = names.partition(" ")
        options.append(Option(names.split(","), kind, meaning))
    positionals = [Positional(names.split()[0], meaning, names.endswith("...")) for names, meaning in found["Positionals"]]
    name = f"{program.name} {command}" if command else program.name
    help = Help(name, about, usage, positionals, options, found["Subcommands"], lines[at:])
    help.children = [read_help(program, name) for name, _ in help.commands]
    return help
