#!/usr/bin/python3
"""Does what a document tells its reader to do: writes its files, runs its commands, and looks for what it says they print.

usage: run_document.py DOCUMENT SOURCE_FOLDER STERNA SCRATCH_FOLDER
- A block ```lua or ```python whose first line is a comment with a file name (-- NAME.lua, # NAME.py) is written to that file; `-- NAME.lua, continued` goes on with it.
- A block ```sh is run line by line in the scratch folder, which is made anew; `sterna` is the program, the environment's STERNA_SHARE the folder of scripts. A line that is to fail
  ends with `  # fails`.
- A block ```text behind a ```sh block is looked for in what that printed, line by line, in its order; `...` stands for anything, a number for any number.
Other blocks, and blocks behind <!-- not run --> , are left alone. Exit status 0 when all is as the document says.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

NUMBER = r"[-+]?\d+(?:[\u202f ]\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"


def blocks_of(text: str):
    """(language, body, is_run) of each fenced block."""
    for found in re.finditer(r"(<!-- not run -->\s*)?^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield found[2], found[3], found[1] is None


def pattern_of(line: str) -> str:
    """A regular expression for a line of a ```text block."""
    made = ""
    for piece in re.split(rf"(\.\.\.|(?<![\w.]){NUMBER})", line.strip()):
        made += ".*" if piece == "..." else NUMBER if re.fullmatch(NUMBER, piece) else re.sub(r"(\\ )+", r"\\s+", re.escape(piece))
    return made


def main() -> int:
    document, source, program, scratch = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "STERNA": str(program), "STERNA_SHARE": str(source), "PYTHONPATH": str(source / "scripting/python")}
    printed, n_commands, n_lines = "", 0, 0
    for language, body, is_run in blocks_of(document.read_text(encoding="utf-8")):
        if not is_run:
            continue
        name = re.match(r"(?:--|#) (\w+\.(?:lua|py))\b(, continued)?", body)
        if language in ("lua", "python") and name:
            with open(scratch / name[1], "a" if name[2] else "w", encoding="utf-8") as file:
                file.write(body)
        elif language == "sh":
            printed = ""
            for command in re.sub(r"\\\n", " ", body).splitlines():
                if not command.strip() or command.startswith("#"):
                    continue
                done = subprocess.run(["bash", "-c", command], cwd=scratch, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
                printed += done.stdout
                n_commands += 1
                if (done.returncode != 0) != command.endswith("  # fails"):
                    print(f"{document.name}: `{command}` ended with status {done.returncode}:\n{done.stdout}")
                    return 1
        elif language == "text":
            where = 0
            for line in body.splitlines():
                if line.strip() in ("", "..."):
                    continue
                found = re.compile(rf"(?<!\w){pattern_of(line)}(?!\w)").search(printed, where)
                if not found:
                    print(f"{document.name}: nothing that was printed is like `{line}` (behind what was found before); printed was:\n{printed}")
                    return 1
                where = found.end()
                n_lines += 1
    print(f"{document.name}: {n_commands} commands ran, {n_lines} lines of output found")
    return 0 if n_commands else 1


if __name__ == "__main__":
    sys.exit(main())
