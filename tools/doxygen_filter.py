#!/usr/bin/env python3
"""Turns the comments of a C header of Ogive into ones that Doxygen reads: what stands before a declaration describes it, what
follows on the same line describes what is before it. struct_size, reserved fields and init functions are described by the
header's beginning and get a line each here.

    doxygen_filter.py HEADER > FILTERED
"""
import re
import sys

with open(sys.argv[1], encoding="utf-8") as stream:
    text = stream.read()


def escaped(comment):
    return re.sub(r"([#<>@\\%])", r"\\\1", comment)


def converted(match):
    before, comment = match.group(1), match.group(2)
    if comment.strip().startswith("---"):
        return before + "/*" + comment + "*/"  # a ruler
    body = escaped(comment)
    return before + ("/**<" if before.strip() else "/**") + body + "*/"


# The first comment describes the file.
text = re.sub(r"\A/\*(.*?)\*/", lambda m: "/** @file\n *" + escaped(m.group(1)) + "*/", text, count=1, flags=re.S)
text = re.sub(r"^([^\n]*?)/\*(?!\*)(.*?)\*/", converted, text, flags=re.S | re.M)
text = re.sub(r"^( +uint32_t struct_size;)$", r"\1 /**< sizeof the struct as its user was compiled */", text, flags=re.M)
text = re.sub(r"^( +u?int32_t reserved\d;)$", r"\1 /**< 0, not used */", text, flags=re.M)
text = re.sub(r"^(OGIVE_API void \w+_def_init\()", r"/** Sets *def to its defaults; size: sizeof *def. NULL is ignored. */\n\1", text,
              flags=re.M)
sys.stdout.write(text)
