# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/python-reference.md, made of the docstrings. Usage: reference.py > ../docs/python-reference.md"""

from __future__ import annotations

import inspect
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

import mesofit  # noqa: E402

GROUPS = (
    ("What is done", ("measure", "fit", "simulate", "open", "import_votca")),
    ("What goes in", ("Frames", "Scene", "law")),
    ("What comes out", ("Result", "Table", "Curves")),
    ("Driven by the caller", ("Simulation", "Rdf", "Means", "FORCE", "OBSERVABLE", "Problem", "State",
                              "Curve", "Value", "Optimiser", "Inversion", "Piece")),
    ("Errors and warnings", ("Error", "InputError", "FileError", "UnstableError", "MesofitWarning",
                             "UnconvergedWarning", "InterruptedWarning")),
)

FUNCTION_TYPES = ("FORCE", "OBSERVABLE")  # of compiled functions


def signature(name: str, thing: Any) -> str:
    """As it is called: without annotations, which the parameters' lines say in words."""
    own = inspect.signature(thing)
    bare = [parameter.replace(annotation=parameter.empty) for key, parameter in
            own.parameters.items() if key != "self"]
    text = str(own.replace(parameters=bare, return_annotation=own.empty))
    text = f"{name}{text}".replace(", /)", ")").replace(", /,", ",")
    indent = " " * (len(name) + 1)
    return textwrap.fill(text, 100, subsequent_indent=indent, break_on_hyphens=False)


def marked(text: str) -> str:
    """Docstring markup as that of pages: ``code`` becomes `code`."""
    return re.sub(r"``(.+?)``", r"`\1`", text, flags=re.S)


def items(lines: list[str]) -> list[str]:
    """Entries of a section: what stands at its margin, and what is indented below it."""
    found: list[list[str]] = []
    for line in filter(str.strip, lines):
        if line.startswith(" "):
            found[-1].append(line.strip())
        else:
            name, _, kind = line.partition(" : ")
            found.append([f"- `{name}`" + (f" ({kind})" if kind else "")])
    return [head + (": " + " ".join(rest) if rest else "") for head, *rest in found]


def render(thing: Any) -> str:
    """A docstring: its text as it is, its sections as lists."""
    parts = re.split(r"(?m)^(\w[\w ]*)\n-{3,}\n", marked(inspect.getdoc(thing) or ""))
    text = [parts[0].strip()]
    for title, body in zip(parts[1::2], parts[2::2]):
        if title == "Notes":
            text.append(body.strip())
        else:
            text.append(f"*{title}*\n\n" + "\n".join(items(body.splitlines())))
    return "\n\n".join(text)


def members(thing: type) -> list[tuple[str, Any]]:
    return [(name, member) for name, member in vars(thing).items()
            if not name.startswith("_") and (inspect.isfunction(member)
                                             or isinstance(member, property))]


def entry(name: str) -> str:
    thing = getattr(mesofit, name)
    plain = not inspect.isclass(thing) or issubclass(thing, (BaseException, tuple))
    if inspect.isfunction(thing):
        heading = signature(name, thing)
    elif plain or name in ("Result", "Table", "Curves", *FUNCTION_TYPES):
        heading = name
    else:
        heading = signature(name, thing.__init__)
    text = [f"### {name}\n"]
    if heading != name:
        text.append(f"```python\n{heading}\n```\n")
    text.append(render(thing) + "\n")
    if inspect.isclass(thing) and not plain and name not in FUNCTION_TYPES:
        for member, value in members(thing):
            called = member if isinstance(value, property) else signature(member, value)
            text.append(f"#### `.{' '.join(called.split())}`\n\n{render(value)}\n")
    return "\n".join(text)


def page() -> str:
    text = ["# Python, name by name\n",
            "Made from the docstrings by `make docs`; [python.md](python.md) shows how they go together.\n"]
    for title, names in GROUPS:
        text.append(f"## {title}\n")
        text += [entry(name) for name in names]
    return "\n".join(text)


if __name__ == "__main__":
    sys.stdout.write(page())
