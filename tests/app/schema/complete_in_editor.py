#!/usr/bin/env python3
"""What an editor's language server completes, explains and marks in a scene, by the schema that is shipped.

usage: complete_in_editor.py SCENE_SCHEMA

Ends with 77, and a note, where there is no yaml-language-server (npm install -g yaml-language-server). Prints what it saw.
"""
import json, pathlib, shutil, subprocess, sys


class LanguageServer:
    """The protocol of language servers: JSON behind a header with its length."""

    def __init__(self, program):
        self.process = subprocess.Popen([program, "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.count = 0
        self.diagnostics = {}

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def notify(self, method, params):
        self.send({"method": method, "params": params})

    def read(self):
        length = 0
        while line := self.process.stdout.readline().strip():
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        if not length:
            sys.exit("the language server has ended")
        return json.loads(self.process.stdout.read(length))

    def hear(self):
        """One message; what the server asks for is answered with nothing."""
        message = self.read()
        if message.get("method") == "textDocument/publishDiagnostics":
            self.diagnostics[message["params"]["uri"]] = [d["message"] for d in message["params"]["diagnostics"]]
        elif "method" in message and "id" in message:
            self.send({"id": message["id"], "result": None})
        return message

    def ask(self, method, params):
        self.count += 1
        self.send({"id": self.count, "method": method, "params": params})
        while True:
            message = self.hear()
            if message.get("id") == self.count and "method" not in message:
                return message.get("result")


def main():
    program = shutil.which("yaml-language-server")
    if not program:
        print("no yaml-language-server here: npm install -g yaml-language-server")
        sys.exit(77)
    schema = pathlib.Path(sys.argv[1]).resolve().as_uri()
    server = LanguageServer(program)
    server.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {"textDocument": {"completion": {"completionItem": {}}, "hover": {}}}})
    server.notify("initialized", {})
    opened = 0

    def open_scene(text):
        """A scene in which | is where one types."""
        nonlocal opened
        opened += 1
        uri = f"file:///scene{opened}.yaml"
        before = text.split("|")[0]
        place = {"line": before.count("\n"), "character": len(before.rsplit("\n", 1)[-1])}
        whole = f"# yaml-language-server: $schema={schema}\n" + text.replace("|", "", 1)
        place["line"] += 1
        server.notify("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "yaml", "version": 1, "text": whole}})
        return {"textDocument": {"uri": uri}, "position": place}

    failures = []

    def expect(what, seen, wanted):
        print(f"{what}: {seen}")
        failures.extend(f"{what}: no {want!r}" for want in wanted if not any(want in one for one in seen))

    def completed(text):
        result = server.ask("textDocument/completion", open_scene(text)) or {"items": []}
        return [item["label"] for item in result["items"]]

    expect("sections", completed("drench: 1\n|"), ["time", "liquid", "fabrics", "output", "transfer"])
    expect("keys of time", completed("drench: 1\ntime:\n  |"), ["dt", "duration", "mode", "integrator"])
    expect("words of time.mode", completed("drench: 1\ntime:\n  mode: |"), ["fixed", "cfl", "adaptive"])
    expect("words of transfer.method", completed("drench: 1\ntransfer:\n  method: |"), ["pic", "flip", "apic", "polypic"])
    expect("bodies of a shape", completed("obstacles:\n  - shape:\n      |"), ["ball", "box", "union"])
    expect("keys of a ball", completed("obstacles:\n  - shape:\n      ball:\n        |"), ["center", "radius"])
    hover = server.ask("textDocument/hover", open_scene("drench: 1\ntime:\n  d|t: 1.0e-3\n"))
    expect("what time.dt means", [json.dumps(hover["contents"])], ["Time step", "[s]", "above 0"])
    wrong = open_scene("drench: 1\ntime: {|dtt: 1.0e-3, mode: fats}\n")["textDocument"]["uri"]
    while not server.diagnostics.get(wrong):
        server.hear()
    expect("what is marked", server.diagnostics[wrong], ["dtt", "adaptive"])
    server.process.kill()
    print("\n".join(failures))
    sys.exit(bool(failures))


main()
