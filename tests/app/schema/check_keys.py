#!/usr/bin/env python3
"""The tables of keys in the manual of scene files against what the program prints.

usage: check_keys.py DRENCH MANUAL

They stand between two marks in the manual, and are written anew where goldens are accepted.
"""
import os, pathlib, subprocess, sys

BEGIN, END = "<!-- keys -->\n", "<!-- end of keys -->\n"

drench, manual = sys.argv[1], pathlib.Path(sys.argv[2])
printed = subprocess.run([drench, "schema", "keys"], capture_output=True, text=True, check=True).stdout
text = manual.read_text()
if text.count(BEGIN) != 1 or text.count(END) != 1:
    sys.exit(f"{manual} needs one line {BEGIN.strip()} and one {END.strip()}")
before, rest = text.split(BEGIN)
written, after = rest.split(END)
if os.environ.get("DRENCH_ACCEPT_GOLDENS"):
    manual.write_text(before + BEGIN + printed + END + after)
    written = printed
if not printed.startswith("### "):
    sys.exit("the program prints no tables")
if written != printed:
    for old, new in zip((written + "\n").splitlines(), printed.splitlines()):
        if old != new:
            print(f"the manual has:     {old}\nthe program prints: {new}")
            break
    sys.exit(f"the keys in {manual} are not those of the program: ./test --accept-goldens -R Schema")
