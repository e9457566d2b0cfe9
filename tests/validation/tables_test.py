#!/usr/bin/python3
"""Where the validation tools put their tables: between marks that a document has once, nowhere else.

  tables_test.py TOOLS_DIRECTORY DOCUMENT...

Refuses a document whose marks are doubled, or where one is without the other, as the tools do.
"""

import collections
import os
import re
import sys
import tempfile

sys.path.insert(0, sys.argv[1])

from plot_common import Refused  # noqa: E402
from validation_table import replace_block  # noqa: E402


def replaced(document, name, text):
    """What replace_block makes of a document; None if it refuses, when the file must be as it was."""
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, "document.md")
        with open(path, "w", encoding="utf-8") as file:
            file.write(document)
        try:
            replace_block(path, name, text)
            refused = False
        except Refused:
            refused = True
        with open(path, encoding="utf-8") as file:
            after = file.read()
    assert not refused or after == document, "a refused document was changed"
    return None if refused else after


def marked(name, text=""):
    return f"<!-- {name}:begin -->\n{text}<!-- {name}:end -->\n"


before, after = "# Rings\n\n", "\n# Spheres\n\n" + marked("spheres", "old\n") + "the end\n"
document = before + marked("rings") + marked("rings-full", "full\n") + after
once = replaced(document, "rings", "| a |\n")
assert once == before + marked("rings", "| a |\n") + marked("rings-full", "full\n") + after, once
assert replaced(once, "rings", "| a |") == once, "the second time must change nothing"
assert replaced(document, "cylinder", "| a |") is None, "marks that are not there must be refused, not appended"
assert replaced(document + marked("rings"), "rings", "| a |") is None, "doubled marks must be refused"
assert replaced("<!-- rings:end -->\n<!-- rings:begin -->\n", "rings", "| a |") is None
assert replaced("<!-- rings:begin -->\n", "rings", "| a |") is None

for path in sys.argv[2:]:
    with open(path, encoding="utf-8") as file:
        marks = re.findall(r"<!-- ([a-z-]+):(begin|end) -->", file.read())
    doubled = [mark for mark, count in collections.Counter(marks).items() if count > 1]
    assert not doubled, f"{path}: doubled: {doubled}"
    assert [name for name, _ in marks[::2]] == [name for name, _ in marks[1::2]], f"{path}: marks do not pair: {marks}"
    assert {kind for _, kind in marks[::2]} <= {"begin"}, f"{path}: an end before its begin"
