# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of docstrings is what they say, and they say all: parameters, what is returned, what is raised."""

import inspect
import re
import subprocess
import sys

import pytest
from conftest import ROOT

import mesofit

sys.path.insert(0, str(ROOT / "python"))

import reference  # noqa: E402


def callables():
    """Names and functions that a user calls, with what documents them."""
    for name in mesofit.__all__:
        thing = getattr(mesofit, name)
        if inspect.isfunction(thing):
            yield name, thing, thing
        elif inspect.isclass(thing) and thing.__module__.startswith("mesofit") and not issubclass(
                thing, (tuple, BaseException)):
            if name not in ("Result", "Table", "Curves", "FORCE", "OBSERVABLE"):  # those are made by others
                yield name, thing.__init__, thing
            for member, value in reference.members(thing):
                if inspect.isfunction(value):
                    yield f"{name}.{member}", value, value


CALLABLES = {name: (function, inspect.getdoc(documented) or "")
             for name, function, documented in callables()}


def section(text, title):
    found = re.search(rf"(?ms)^{title}\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", text)
    return found.group(1) if found else ""


def test_page_is_that_of_the_docstrings():
    assert (ROOT / "docs" / "python-reference.md").read_text() == reference.page(), "make docs"


def test_page_has_all_public_names():
    named = {name for _, names in reference.GROUPS for name in names}
    assert named == set(mesofit.__all__) - {"__version__"}


@pytest.mark.parametrize("name", CALLABLES)
def test_docstring_is_complete(name):
    function, text = CALLABLES[name]
    parameters = inspect.signature(function).parameters.values()
    wanted = [("**" if each.kind == each.VAR_KEYWORD else "") + each.name
              for each in parameters if each.name != "self"]
    heads = re.findall(r"(?m)^(\S.*?)(?: : .*)?$", section(text, "Parameters"))
    assert [part.strip() for head in heads for part in head.split(",")] == wanted or not wanted
    returned = inspect.signature(function).return_annotation
    if returned not in (inspect.Signature.empty, "None"):
        assert section(text, "Returns")
    elif not name[0].isupper() or "." in name:
        assert not section(text, "Returns")


@pytest.mark.parametrize("name", [name for name in mesofit.__all__ if name != "__version__"])
def test_every_name_and_property_says_what_it_is(name):
    thing = getattr(mesofit, name)
    assert inspect.getdoc(thing)
    for _, member in reference.members(thing) if inspect.isclass(thing) else ():
        assert inspect.getdoc(member)


def test_types_hold():
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir=/dev/null"],
                          cwd=ROOT / "python", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
