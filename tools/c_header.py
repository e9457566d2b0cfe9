"""Reads the C headers of Ogive far enough to list what they declare: constants, structs with their fields, functions.

The headers keep to a small part of C on purpose: fixed-width numbers, arrays of them, pointers, opaque types.
"""
import re


class Field:
    def __init__(self, type_, name, count):
        self.type, self.name, self.count = type_, name, count  # count: elements of an array, 0 for a scalar

    def __repr__(self):
        return f"{self.type} {self.name}" + (f"[{self.count}]" if self.count else "")


class Function:
    def __init__(self, result, name, arguments):
        self.result, self.name, self.arguments = result, name, arguments


class Header:
    """constants: [(name, value)], structs: {name: [Field]}, functions: [Function], in the header's order."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as stream:
            text = stream.read()
        self.text = text
        code = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
        self.constants = [(name, int(value)) for name, value in
                          re.findall(r"^#define (OGIVE_\w+) (-?\d+)[ \t]*$", code, flags=re.M)]
        code = re.sub(r"^#.*$", " ", code, flags=re.M)
        code = re.sub(r"\s+", " ", code)
        for body in re.findall(r"\benum \{(.*?)\}", code):
            next_value = 0
            for entry in filter(None, (part.strip() for part in body.split(","))):
                name, _, value = (part.strip() for part in entry.partition("="))
                next_value = int(value) if value else next_value
                self.constants.append((name, next_value))
                next_value += 1
        self.structs = {name: self._fields(body) for body, name in
                        re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", code)}
        self.functions = [Function(result.strip(), name, self._arguments(arguments)) for result, name, arguments in
                          re.findall(r"OGIVE_API ([\w *]+?) ?\b(ogive_\w+)\((.*?)\);", code)]

    @staticmethod
    def _fields(body):
        fields = []
        for declaration in filter(None, (part.strip() for part in body.split(";"))):
            pointer = re.match(r"[\w ]+\(\*(\w+)\)\(", declaration)
            if pointer:
                fields.append(Field("function pointer", pointer.group(1), 0))
                continue
            type_, names = re.match(r"((?:const )?\w+(?: ?\*)?) ?(.*)", declaration).groups()
            for name in names.split(","):
                name, count = re.match(r"\s*(\w+)(?:\[(\d+)\])?\s*$", name).groups()
                fields.append(Field(type_.replace(" ", "") if "*" not in type_ else type_.replace(" *", "*"), name,
                                    int(count or 0)))
        return fields

    @staticmethod
    def _arguments(text):
        if text.strip() == "void":
            return []
        arguments = []
        for argument in text.split(","):
            type_, name = re.match(r"\s*(.*?[ *])(\w+)\s*$", argument).groups()
            arguments.append(Field(type_.strip().replace(" *", "*"), name, 0))
        return arguments
