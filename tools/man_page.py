# SPDX-License-Identifier: MIT
"""A Help (program_help.py) as a manual page in the man macros."""
import re
import textwrap

EXIT_CODES = "Exit codes: "
SEE_ALSO_FOLDER = "/usr/share/doc/knotwave"
EXAMPLES_FOLDER = "/usr/share/knotwave"


def literal(text):
    """Text that is copied: every sign stays what it is."""
    for sign, escape in (("\\", r"\e"), ("-", r"\-"), ("'", r"\(aq"), ("`", r"\(ga"), ("^", r"\(ha"), ("~", r"\(ti")):
        text = text.replace(sign, escape)
    return rf"\&{text}" if text.startswith(".") else text


def running(text):
    """Prose, in which options and names of programs can be copied."""
    def part(word):
        return word.replace("-", r"\-") if re.match(r"[('\"]*(-|knotwave-)", word) else word
    text = " ".join(part(word.replace("\\", r"\e")) for word in text.split(" "))
    lines = textwrap.wrap(text, 78, break_long_words=False, break_on_hyphens=False)
    return "\n".join(rf"\&{line}" if line.startswith((".", "'")) else line for line in lines)


def typed(kind):
    """What stands behind an option: bold as written, italic what is put in."""
    def part(word):
        return rf"\fI{literal(word)}\fR" if re.match("[A-Z]|[A-Z]?[a-z]+[A-Z]", word) else rf"\fB{literal(word)}\fR"
    return "|".join(part(word) for word in kind.split("|"))


def definitions(items):
    return [line for term, about in items for line in (".TP", term, running(about))]


def option_items(help):
    for option in help.options:
        names = ", ".join(rf"\fB{literal(name)}\fR" for name in option.names)
        yield (f"{names} {typed(option.type)}" if option.type else names), option.about


def positional_items(help):
    for positional in help.positionals:
        yield typed(positional.name) + (" ..." if positional.is_many else ""), positional.about


def usage_line(help):
    """The words of the usage: those of the program bold, places italic."""
    def part(word):
        return re.sub(r"[A-Z]+", lambda name: rf"\fI{name[0]}\fR", word) if re.search("[A-Z]", word) else rf"\fB{literal(word)}\fR"
    return " ".join(part(word) for word in help.usage.split())


def paragraphs(lines):
    """Blocks of a note: ("text", str), ("example", [lines]) for what is shown, ("exits", [(code, meaning)])."""
    blocks = []
    text, shown = [], []

    def close():
        if shown:
            blocks.append(("example", [line[2:] for line in shown]))
        joined = " ".join(text)
        if joined.startswith(EXIT_CODES):
            codes = joined.removeprefix(EXIT_CODES).removesuffix(".")
            blocks.append(("exits", [part.split(" ", 1) for part in re.split(r", (?=\d+ )", codes)]))
        elif joined:
            blocks.append(("text", joined))
        text.clear()
        shown.clear()

    for line in lines:
        if line.startswith("  "):
            if text:
                close()
            shown.append(line)
        else:
            if shown or not line or line.startswith(EXIT_CODES):
                close()
            if line:
                text.append(line)
    close()
    return blocks


def shown(lines):
    return [".PP", ".RS 4", ".nf", *(literal(line) for line in lines), ".fi", ".RE"]


def is_heading(block):
    return block[0] == "text" and block[1] in ("Example:", "Examples:")


def notes(blocks):
    out = []
    for kind, what in blocks:
        out += [".PP", running(what)] if kind == "text" else shown(what)
    return out


def command_section(help):
    out = [f'.SS "{literal(help.name.split()[1])}"', usage_line(help), ".PP", running(sentence(help.about))]
    items = [*positional_items(help), *((names, about) for names, about in option_items(help) if "help" not in names)]
    return out + definitions(items) + notes(paragraphs(help.notes))


def sentence(text):
    return f"{text[0].upper()}{text[1:].removesuffix('.')}."


def man_page(help, version, others):
    """`others` are the names of our other programs."""
    blocks = paragraphs(help.notes)
    examples, prose, exits = [], [], []
    for i, block in enumerate(blocks):
        if block[0] == "exits":
            exits = block[1]
        elif block[0] == "example" and i > 0 and is_heading(blocks[i - 1]):
            examples += block[1]
        elif not is_heading(block):
            prose.append(block)
    summary, _, rest = help.about.partition(". ")
    summary = summary.removesuffix(".")
    out = [rf'.\" Made by tools/program_pages.py from {help.name} --help.',
           f'.TH {literal(help.name).upper()} 1 "" "Knotwave {version}" "Knotwave"',
           ".SH NAME", running(rf"{help.name} - {summary[0].lower()}{summary[1:]}"),
           ".SH SYNOPSIS", usage_line(help),
           ".SH DESCRIPTION", running(sentence(summary))]
    out += [running(rest)] if rest else []
    out += notes(prose)
    out += definitions(positional_items(help))
    out += [".SH OPTIONS", *definitions(option_items(help))]
    if help.children:
        out += [".SH COMMANDS"]
        for child in help.children:
            out += command_section(child)
    if examples:
        out += [".SH EXAMPLES", *shown(examples)[1:]]
    if exits:
        out += [".SH EXIT STATUS", *definitions((rf"\fB{code}\fR", sentence(meaning)) for code, meaning in exits)]
    out += [".SH FILES", ".TP", rf"\fI{EXAMPLES_FOLDER}/examples\fR",
            "Patches, banks, curves, scores and tunings to start from.",
            "Commands that name files of examples/ work as they are printed in",
            f"{EXAMPLES_FOLDER}; under another prefix than /usr it is PREFIX/share/knotwave.",
            ".SH SEE ALSO"]
    out += [",\n".join([*(rf"\fB{literal(name)}\fR(1)" for name in others), rf"\fI{SEE_ALSO_FOLDER}\fR"])]
    return "\n".join(out) + "\n"
