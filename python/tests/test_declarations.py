# SPDX-License-Identifier: GPL-3.0-or-later
"""What the package declares is what the headers declare: both are read, and the compiler judges."""

import ctypes
import inspect
import re
import shutil
import subprocess

import pytest
from conftest import PROGRAM, ROOT

import mesofit
from mesofit import _library, _work

HEADERS = sorted((ROOT / "include" / "mesofit").glob("*.h"))


def declarations():
    """Text of all headers without comments, blanks made one."""
    text = "\n".join(path.read_text() for path in HEADERS)
    return re.sub(r"\s+", " ", re.sub(r"/\*.*?\*/", "", text, flags=re.S))


def functions():
    """Name: (what it returns, its parameters)."""
    found = re.findall(r"MESOFIT_API ([^;]*?)(mesofit_\w+)\(([^;]*)\);", declarations())
    return {name: (result.strip(), [] if inside == "void" else inside.split(", "))
            for result, name, inside in found}


POINTERS = {"double": _library.NUMBERS, "char": ctypes.c_char_p,
            "uint32_t": ctypes.POINTER(ctypes.c_uint32),
            "size_t": ctypes.POINTER(ctypes.c_size_t)}
PLAIN = {"void": None, "int": ctypes.c_int, "size_t": ctypes.c_size_t, "double": ctypes.c_double,
         "uint32_t": ctypes.c_uint32, "uint64_t": ctypes.c_uint64, "int64_t": ctypes.c_int64}
CALLBACKS = {"mesofit_force": _library.FORCE, "mesofit_fit_progress": _library.FIT_PROGRESS}


def python_type(text):
    """What a type of the headers is to ctypes."""
    words = text.replace("*", " * ").replace("const", "").split()
    stars = words.count("*")
    words = [word for word in words if word not in ("*", "struct", "enum")]
    base = words[0]
    if base in CALLBACKS:
        return CALLBACKS[base]
    if stars == 0:
        return ctypes.c_int if "enum" in text else PLAIN.get(base, _library.STRUCTS.get(base))
    if base in _library.STRUCTS and stars == 1:
        return ctypes.POINTER(_library.STRUCTS[base])
    if base.startswith("mesofit_") or base == "void":
        return ctypes.c_void_p
    one = POINTERS[base]
    return one if stars == 1 else ctypes.POINTER(one)


def parameter_type(text):
    """Without its name, if it has one."""
    return python_type(re.sub(r"(?<=[ *])\w+$", "", text) if not text.endswith("*") else text)


def test_all_functions_are_used_or_known_not_to_be():
    assert set(functions()) == set(_library.FUNCTIONS) | _library.UNUSED
    assert not set(_library.FUNCTIONS) & _library.UNUSED


def test_functions_have_the_types_of_the_headers():
    for name, (result, arguments) in _library.FUNCTIONS.items():
        wanted_result, wanted = functions()[name]
        assert result is python_type(wanted_result), name
        assert arguments == [parameter_type(text) for text in wanted], name


@pytest.mark.skipif(shutil.which("cc") is None, reason="no compiler")
def test_structs_have_the_bytes_of_the_headers(tmp_path):
    checks = []
    for name, struct in _library.STRUCTS.items():
        checks.append(f"_Static_assert(sizeof(struct {name}) == {ctypes.sizeof(struct)}, \"\");")
        for field, _ in struct._fields_:
            place, size = getattr(struct, field).offset, getattr(struct, field).size
            checks.append(f"_Static_assert(offsetof(struct {name}, {field}) == {place} && "
                          f"sizeof(((struct {name} *)0)->{field}) == {size}, \"{field}\");")
    source = tmp_path / "check.c"
    source.write_text("#include <mesofit.h>\n#include <stddef.h>\n" + "\n".join(checks))
    subprocess.run(["cc", "-std=c11", "-fsyntax-only", f"-I{ROOT / 'include'}", str(source)],
                   check=True)


def test_enumeration_is_that_of_the_headers():
    inside = re.search(r"enum mesofit_status \{(.*?)\}", declarations()).group(1)
    names = [word.split("=")[0].strip().removeprefix("MESOFIT_") for word in inside.split(",")]
    assert [getattr(_library, name) for name in names] == list(range(7))


def test_another_library_is_noticed(monkeypatch):
    class Short(ctypes.Structure):
        _fields_ = [("name", ctypes.c_char_p)]
    monkeypatch.setitem(_library.STRUCTS, "mesofit_table", Short)
    with pytest.raises(ImportError, match="different versions"):
        _library._declare(_library.lib, "libmesofit.so")
    monkeypatch.undo()
    monkeypatch.setitem(_library.FUNCTIONS, "mesofit_newest", (None, []))
    with pytest.raises(ImportError, match="older mesofit"):
        _library._declare(_library.lib, "libmesofit.so")


def test_measure_has_the_options_of_the_program():
    help_text = subprocess.run(
        [PROGRAM, "measure", "--help"], capture_output=True,
        text=True).stdout.split("options of all commands")[0]
    options = {word.lstrip("-").replace("-", "_") for word in
               re.findall(r"^ +(--?[a-z][a-z-]*)", help_text, re.M)}
    assert options - {"s"} == set(_work.MEASURE_OPTIONS) - {"structure"}


def test_version_is_the_programs():
    text = subprocess.run([PROGRAM, "--version"], capture_output=True,
                          text=True).stdout
    assert text.split()[1] == mesofit.__version__


def test_public_names_have_words():
    for name in mesofit.__all__:
        thing = getattr(mesofit, name)
        assert name in ("__version__", "FORCE", "OBSERVABLE") or inspect.getdoc(thing), name
