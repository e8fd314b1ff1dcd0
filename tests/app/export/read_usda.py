"""A strict reader of as much of USD's text format as geometry files use; what else there is, it refuses.

read_usda(text) gives {"metadata": {...}, "prims": {"/path": {"specifier", "type", "metadata", "attributes": {name: {"type", "uniform",
"metadata", "value", "samples": {time: value}}}}}}. Tuples and lists become lists, assets strings, dictionaries dicts.
"""

import re

TOKEN = re.compile(r'"(?P<string>[^"\n]*)"|@(?P<asset>[^@\n]*)@|(?P<number>-?\d+(\.\d+)?(e[+-]?\d+)?)(?![\w.])|(?P<word>[A-Za-z_][\w:.]*(\[\])?)|(?P<mark>[][(){},=:])|(?P<space>\s+)')
KINDS = ("string", "asset", "number", "word", "mark", "space")
TYPES = {"float", "int", "int64", "double2", "float3", "point3f", "vector3f", "normal3f", "token", "string", "asset", "bool", "dictionary"}


class Reader:
    def __init__(self, text):
        assert text.startswith("#usda 1.0\n"), "no head"
        self.tokens, at = [], len("#usda 1.0\n")
        while at < len(text):
            match = TOKEN.match(text, at)
            assert match, f"what is this: {text[at:at + 40]!r}"
            kind = next(k for k in KINDS if match.group(k) is not None)
            if kind != "space":
                self.tokens.append((kind, match.group(kind)))
            at = match.end()
        self.tokens.append(("end", ""))
        self.at = 0

    def peek(self, mark):
        return self.tokens[self.at] == ("mark", mark)

    def take(self, kind, value=None):
        found = self.tokens[self.at]
        assert found[0] == kind and value in (None, found[1]), f"token {self.at}: {kind} {value or ''} expected, not {found}"
        self.at += 1
        return found[1]

    def has(self, mark):
        if self.peek(mark):
            self.at += 1
            return True
        return False

    def value(self):
        kind, text = self.tokens[self.at]
        if kind == "number":
            self.at += 1
            return float(text) if re.search(r"[.e]", text) else int(text)
        if kind in ("string", "asset"):
            self.at += 1
            return text
        if self.has("["):
            return self.sequence("]")
        assert self.has("("), f"token {self.at}: a value expected, not {text}"
        return self.sequence(")")

    def sequence(self, end):
        values = []
        while not self.has(end):
            values.append(self.value())
            if not self.peek(end):
                self.take("mark", ",")
        return values

    def dictionary(self):
        entries = {}
        self.take("mark", "{")
        while not self.has("}"):
            kind, key = self.take("word"), self.take("word")
            assert kind.removesuffix("[]") in TYPES and key not in entries, key
            self.take("mark", "=")
            entries[key] = self.dictionary() if kind == "dictionary" else self.value()
        return entries

    def metadata(self):
        entries = {}
        if not self.has("("):
            return entries
        while not self.has(")"):
            key = self.take("word")
            assert key not in entries, key
            self.take("mark", "=")
            entries[key] = self.dictionary() if self.peek("{") else self.value()
        return entries

    def samples(self):
        by_time = {}
        self.take("mark", "{")
        while not self.has("}"):
            time = self.take("number")
            assert time not in by_time, time
            self.take("mark", ":")
            by_time[time] = self.value()
            self.take("mark", ",")
        return by_time

    def attribute(self, attributes):
        kind = self.take("word")
        uniform = kind == "uniform"
        if uniform:
            kind = self.take("word")
        assert kind.removesuffix("[]") in TYPES, kind
        name = self.take("word")
        sampled = name.endswith(".timeSamples")
        known = attributes.setdefault(name.removesuffix(".timeSamples"), {"type": kind, "uniform": uniform, "metadata": {}})
        assert known["type"] == kind, name
        if sampled:
            self.take("mark", "=")
            assert "samples" not in known, name
            known["samples"] = self.samples()
        elif self.has("="):
            known["value"] = self.value()
        else:
            known["metadata"] = self.metadata()

    def prim(self, parent, prims):
        specifier, kind = self.take("word"), ""
        assert specifier in ("def", "over"), specifier
        if self.tokens[self.at][0] == "word":
            kind = self.take("word")
        path = f"{parent}/{self.take('string')}"
        assert re.fullmatch(r"(/[A-Za-z_]\w*)+", path) and path not in prims, path
        attributes = {}
        prims[path] = {"specifier": specifier, "type": kind, "metadata": self.metadata(), "attributes": attributes}
        self.take("mark", "{")
        while not self.has("}"):
            if self.tokens[self.at][1] in ("def", "over"):
                self.prim(path, prims)
            else:
                self.attribute(attributes)


def read_usda(text):
    reader, prims = Reader(text), {}
    metadata = reader.metadata()
    while reader.tokens[reader.at][0] != "end":
        reader.prim("", prims)
    return {"metadata": metadata, "prims": prims}
