#!/usr/bin/env python3
"""The schemas that are shipped against the scenes that there are, and against the reader.

usage: check_schema.py DRENCH SCENES SPOILT

They must be those that the program writes, and say of every key what it means. Every scene must be valid. Then so many scenes are spoilt, each at one place: what the schema
refuses the reader must refuse, and a key that the reader does not know the schema must refuse too.
"""
import copy, json, os, pathlib, random, re, shutil, subprocess, sys, tempfile

import jsonschema, yaml


UNIT_AND_RANGE = r"\[[^]]*\]|\b(above|below|at least|at most) \S+|[-0-9.e+]+ to [-0-9.e+]+|, "


class Yaml12(yaml.SafeLoader):
    """Plain words as YAML 1.2 and Drench have them: off and yes are words."""

    yaml_implicit_resolvers = {}


Yaml12.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), "tf")
Yaml12.add_implicit_resolver("tag:yaml.org,2002:int", re.compile("^[-+]?[0-9]+$"), "-+0123456789")
Yaml12.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?([0-9]+\.[0-9]*|\.[0-9]+|[0-9]+(?=[eE]))([eE][-+]?[0-9]+)?$"), "-+.0123456789")
Yaml12.add_implicit_resolver("tag:yaml.org,2002:null", re.compile("^(~|null|)$"), ["~", "n", ""])
Yaml12.add_implicit_resolver("tag:yaml.org,2002:merge", re.compile("^<<$"), "<")
# "08" is a number to Drench and no octal one.
Yaml12.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))
Yaml12.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def problem(validator, scene):
    error = jsonschema.exceptions.best_match(validator.iter_errors(scene))
    return error and f"{'.'.join(map(str, error.absolute_path))}: {error.message[:200]}"


def places(value, path=()):
    """Paths of all values below this one."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, below in items:
        yield path + (key,)
        yield from places(below, path + (key,))


def spoil(scene, dice):
    """A scene with one key misspelt or one value of another kind, and whether it was a key."""
    spoilt = copy.deepcopy(scene)
    path = dice.choice(list(places(spoilt)))
    parent = spoilt
    for key in path[:-1]:
        parent = parent[key]
    if isinstance(parent, dict) and dice.random() < 0.5:
        parent[str(path[-1]) + "_x"] = parent.pop(path[-1])
        return spoilt, path, True
    parent[path[-1]] = dice.choice([None, "no_such_word", -3.5, [1, 2, 3, 4, 5, 6, 7], {"nothing": 1}, True])
    return spoilt, path, False


def read_schema(drench, scenes, kind):
    """The one that is shipped, which is written anew where goldens are accepted."""
    shipped = scenes / "schema" / f"{kind}.schema.json"
    written = subprocess.run([drench, "schema", kind], capture_output=True, text=True, check=True).stdout
    if os.environ.get("DRENCH_ACCEPT_GOLDENS"):
        shipped.write_text(written)
    if shipped.read_text() != written:
        sys.exit(f"{shipped} is not what the program writes: drench schema {kind} --out {shipped}")
    schema = json.loads(written)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def keys_without_meaning(schema, path=""):
    """Keys of which an editor would have nothing to say."""
    for key, below in schema.get("properties", {}).items() if isinstance(schema, dict) else ():
        if "$ref" not in below and not re.sub(UNIT_AND_RANGE, "", below.get("description", "")):
            yield f"{path}/{key}"
    items = schema.items() if isinstance(schema, dict) else enumerate(schema) if isinstance(schema, list) else ()
    for key, below in items:
        yield from keys_without_meaning(below, f"{path}/{key}")


def judge(drench, validator, file, spoilt, where):
    """What schema and reader say of a scene that stands in for another, and a complaint where they contradict each other."""
    file.write_text(yaml.safe_dump(spoilt))
    read = subprocess.run([drench, "check", str(file)], capture_output=True, text=True)
    refused, unknown = problem(validator, spoilt), "unknown key" in read.stderr
    complaint = None
    if refused and read.returncode == 0:
        complaint = f"{where}: the schema refuses what the reader takes: {refused}"
    if not refused and unknown:
        complaint = f"{where}: the schema takes what the reader refuses: {read.stderr.strip()}"
    return bool(refused), unknown, complaint


def main():
    drench, scenes, count = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    validator = read_schema(drench, scenes, "scene")
    read_schema(drench, scenes, "study")
    dice = random.Random(1)
    with tempfile.TemporaryDirectory() as copies:
        folder = shutil.copytree(scenes, pathlib.Path(copies) / "scenes")
        whole = {file: yaml.load(file.read_text(), Yaml12) for file in sorted(folder.rglob("*.yaml"))}
        failures = [f"{file}: the schema refuses {what}" for file, scene in whole.items() if (what := problem(validator, scene))]
        failures += [f"{key}: the schema does not say what it means" for key in keys_without_meaning(validator.schema)]
        refused = unknown = 0
        for _ in range(count):
            file, scene = dice.choice(list(whole.items()))
            spoilt, path, is_key = spoil(scene, dice)
            where = f"{file.relative_to(folder)}, {'.'.join(map(str, path))}{' misspelt' if is_key else ''}"
            by_schema, by_reader, complaint = judge(drench, validator, file.with_name("spoilt.yaml"), spoilt, where)
            refused, unknown, failures = refused + by_schema, unknown + by_reader, failures + ([complaint] if complaint else [])
    print(f"{len(whole)} scenes, {count} spoilt: {refused} refused by the schema, {unknown} for a key that the reader does not know")
    print("\n".join(failures))
    sys.exit(bool(failures) or refused == 0 or unknown == 0)


main()
