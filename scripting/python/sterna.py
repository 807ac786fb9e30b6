"""Python interface of sterna: commands as functions, JSON as dictionaries. One file, standard library only; docs/python.md has examples.

    import sterna
    wall = sterna.surface("d150.xml", "wall.stl", max_edge=0.4)
    mesh = sterna.mesh("wall.stl", "case.su2", layers=30, first_height=1e-5, farfield="sphere radius=400")
    print(mesh["verdict"], mesh["mesh"]["nodes"], sterna.check("case.su2")["quality_verdict"])

Options are those of the command line with _ for - (`sterna mesh --help`): numbers, strings, True and False; a list gives an option several times. Lengths are metres, angles degrees
or strings with a unit ("12*deg"), as on the command line. Errors raise SternaError with the message of the program.
"""
from __future__ import annotations

import codecs
import collections.abc
import dataclasses
import json
import os
import pathlib
import pty
import re
import shutil
import signal
import subprocess
import threading
import time
import typing

__all__ = [
    "CaseFailure", "InvalidMesh", "Progress", "ProgramNotFound", "Sterna", "SternaError", "Stopped", "TimedOut", "UsageError", "check", "check_family", "check_script", "convert",
    "draw", "find_program", "info", "inspect", "mesh", "read_manifest", "read_series", "report", "run", "series", "surface", "union", "version",
]

Path = typing.Union[str, os.PathLike]
Paths = typing.Union[Path, collections.abc.Iterable[Path]]

Arguments = typing.Union[collections.abc.Mapping[str, object], collections.abc.Iterable[typing.Union[str, tuple[str, object]]]]  # {"alpha": 4} or ["alpha=4"]

_K_STOP_SECONDS = 10.0  # sterna ends within a second of an interrupt; its engines are given time to clean up


@dataclasses.dataclass(frozen=True)
class Progress:
    """Argument of a progress callback."""

    share: float  # of the work, 0 .. 1
    stage: str  # "volume_mesh/envelope"
    left: str | None  # "40 s", "1:02 min"; None before the program ventures a guess


@dataclasses.dataclass(frozen=True)
class Place:
    """A location in a message."""

    at: tuple[float, float, float]  # m
    what: str


class SternaError(RuntimeError):
    """A command failed. str() is the message of the program: attempted action, problem, locations, remedy."""

    def __init__(self, message: str, command: list[str] | None = None, status: int | None = None, output: str = "", warnings: list[str] | None = None):
        super().__init__(message)
        self.message = message
        self.command = command or []  # as it was run
        self.status = status  # exit status; negative: the signal that killed it
        self.output = output  # what it had printed
        self.warnings = warnings or []

    @property
    def places(self) -> list[Place]:
        """Locations listed in the message."""
        number = r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)"
        found = re.finditer(rf"^\s*at \({number}, {number}, {number}\)(?: on ([^:]*))?: (.*)$", self.message, re.MULTILINE)
        return [Place((float(m[1]), float(m[2]), float(m[3])), m[5] if m[4] is None else f"{m[4]}: {m[5]}") for m in found]

    @property
    def advice(self) -> str | None:
        """Remedy in the message; None if there is none."""
        found = re.search(r"^\s*try: (.*)$", self.message, re.MULTILINE)
        return found[1] if found else None


class UsageError(SternaError):
    """Exit status 2: the command line, an option or a script is wrong; nothing was made."""


class InvalidMesh(SternaError):
    """Exit status 3 of a command that makes a mesh: the mesh was written, but is INVALID."""


class Stopped(SternaError):
    """Exit status 130: interrupted."""


class TimedOut(SternaError):
    """The program was stopped after `timeout` seconds."""


class CaseFailure(SternaError):
    """Raised by `series(..., must_succeed=True)` if not all cases are VALID. `cases`: the cases that are not VALID."""

    def __init__(self, message: str, cases: list[dict]):
        super().__init__(message)
        self.cases = cases


class ProgramNotFound(SternaError):
    """The program sterna was not found."""


def find_program(program: Path | None = None) -> str:
    """Returns the program to run: `program` if given, else the environment's STERNA, else sterna in PATH, else ../../../bin/sterna of an installed sterna.py.

    Raises ProgramNotFound with the searched locations.
    """
    looked = []
    for source, name in (("the argument", program), ("the environment's STERNA", os.environ.get("STERNA"))):
        if name:
            found = shutil.which(os.fspath(name))
            if found:
                return os.path.abspath(found)  # a relative one has to be found from other folders, too
            raise ProgramNotFound(f"{source} says {os.fspath(name)!r}, which is not an executable program")
        looked.append(source)
    installed = pathlib.Path(__file__).resolve().parent.parent.parent.parent / "bin" / "sterna"
    found = shutil.which("sterna") or (str(installed) if os.access(installed, os.X_OK) else None)
    if found:
        return os.path.abspath(found)
    raise ProgramNotFound(f"the program sterna was not found: neither {' nor '.join(looked)} is set, and it is not in PATH or {installed}; use Sterna(program) or STERNA=/path/to/sterna")


def _value_text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, float):
        return repr(value)  # all digits
    if isinstance(value, (str, int)):
        return str(value)
    raise TypeError(f"{value!r} of type {type(value).__name__} is not a value of an option; expected a number, a string, a path, True, False or a list of these")


def _list_of(value: object) -> list:
    return [value] if isinstance(value, (str, os.PathLike)) or not isinstance(value, collections.abc.Iterable) else list(value)


def _paths(value: object, what: str) -> list:
    """Returns one path or several as a list; any other value is a TypeError here, instead of a missing file in the program."""
    paths = _list_of(value)
    if isinstance(value, (bytes, collections.abc.Mapping)) or not all(isinstance(path, (str, os.PathLike)) for path in paths):
        raise TypeError(f"{what}: expected a path or a list of paths, not {value!r}")
    return paths


def _one_path(value: object, what: str) -> Path:
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{what}: expected one path, not {value!r}")
    return value


def _script_arguments(arguments: object) -> list[str]:
    """Returns NAME=VALUE strings from a dictionary, or from a list of such strings or pairs."""
    if arguments is None:
        return []
    if isinstance(arguments, collections.abc.Mapping):
        arguments = arguments.items()
    elif isinstance(arguments, (str, bytes)) or not isinstance(arguments, collections.abc.Iterable):
        raise TypeError(f"arguments: expected a dictionary {{'alpha': 4}} or a list ['alpha=4'], not {arguments!r}")
    made = []
    for entry in arguments:
        if isinstance(entry, str) and re.match(r"\w+=", entry):
            made.append(entry)
        elif isinstance(entry, tuple) and len(entry) == 2 and isinstance(entry[0], str):
            made.append(f"{entry[0]}={_value_text(entry[1])}")
        else:
            raise TypeError(f"arguments: {entry!r} is neither 'name=value' nor a pair (name, value)")
    return made


def _option_arguments(options: collections.abc.Mapping[str, object]) -> list[str]:
    """Returns --name=value for each option; None is omitted. `set` and `patch` take dictionaries: set={"envelope.layers": 24}, patch={"tunnel*": {"layers": 20}}."""
    made = []
    for name, value in options.items():
        if value is None:
            continue
        if name == "set" and isinstance(value, collections.abc.Mapping):
            value = [f"{option}={_value_text(entry)}" for option, entry in value.items()]
        elif name == "patch" and isinstance(value, collections.abc.Mapping):
            for patch, rules in value.items():
                if not isinstance(rules, collections.abc.Mapping):
                    raise TypeError(f"patch {patch!r}: expected a dictionary of options, e.g. {{'layers': 20}}, not {rules!r}")
            value = [f"{patch}:" + ",".join(f"{option}={_value_text(entry)}" for option, entry in rules.items()) for patch, rules in value.items()]
        elif isinstance(value, collections.abc.Mapping):
            raise TypeError(f"option {name} takes no dictionary; only set and patch do")
        made += [f"--{name.replace('_', '-')}={_value_text(entry)}" for entry in _list_of(value)]
    return made


class _Messages:
    """Parses stderr of the program: lines of the log, and the progress line, which is overwritten repeatedly."""

    def __init__(self, on_progress: collections.abc.Callable[[Progress], None] | None, on_log: collections.abc.Callable[[str], None] | None):
        self.lines: list[str] = []
        self._on_progress, self._on_log = on_progress, on_log
        self._decode = codecs.getincrementaldecoder("utf-8")("replace").decode
        self._rest = ""

    def take(self, data: bytes, is_last: bool = False) -> None:
        pieces = re.split(r"\r?\n|\r", self._rest + self._decode(data, is_last))
        self._rest = "" if is_last else pieces.pop()
        if self._rest.endswith("\x1b[K"):  # a line of progress is whole when it has wiped what was behind it
            pieces.append(self._rest)
            self._rest = ""
        for piece in pieces:
            self._take_line(re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", piece))

    def _take_line(self, line: str) -> None:
        progress = re.fullmatch(r"\[\s*(\d+) %\] (.*?)(?:, about (.+) left)?", line)
        if progress:
            if self._on_progress:
                self._on_progress(Progress(int(progress[1]) / 100.0, progress[2], progress[3]))
        elif line.strip():
            self.lines.append(line)
            if self._on_log:
                self._on_log(line)

    def _blocks(self, prefix: str) -> list[str]:
        """Returns the messages that begin with the prefix, with their indented lines."""
        blocks: list[str] = []
        is_inside = False
        for line in self.lines:
            if line.startswith(prefix):
                blocks.append(line.removeprefix(prefix))
                is_inside = True
            elif is_inside and line.startswith(" "):
                blocks[-1] += "\n" + line
            else:
                is_inside = False
        return blocks

    @property
    def warnings(self) -> list[str]:
        return self._blocks("warning: ")

    @property
    def error(self) -> str:
        errors = self._blocks("error: ")
        return "\n".join(errors) if errors else "\n".join(self.lines[-20:])


@dataclasses.dataclass(frozen=True)
class _Done:
    status: int
    output: str
    warnings: list[str]
    error: SternaError | None


def _stop(process: subprocess.Popen) -> None:
    if process.poll() is not None:
        return
    process.send_signal(signal.SIGINT)
    try:
        process.wait(_K_STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _execute(command: list[str], folder: Path | None, messages: _Messages, wants_progress: bool, timeout: float | None) -> tuple[int, str]:
    """Runs the command; returns exit status and stdout. stderr goes to messages; for progress through a pseudo terminal, because progress is written to terminals only."""
    reader, writer = pty.openpty() if wants_progress else os.pipe()
    try:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=writer)
    except OSError as failure:
        os.close(reader)
        raise ProgramNotFound(f"running {command[0]}: {failure.strerror}", command) from failure
    finally:
        os.close(writer)
    failures: list[BaseException] = []

    def read_messages() -> None:
        try:
            while True:
                try:
                    data = os.read(reader, 65536)
                except OSError:  # a pseudo terminal whose other end is closed
                    data = b""
                messages.take(data, not data)
                if not data:
                    return
        except BaseException as failure:  # of a callback: raised in the caller's thread, below
            failures.append(failure)
            _stop(process)

    thread = threading.Thread(target=read_messages, daemon=True)
    thread.start()
    try:
        output, _ = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        _stop(process)
        raise TimedOut(f"{' '.join(command)}: stopped after {timeout} s", command, process.returncode, "", messages.warnings) from None
    except BaseException:  # Ctrl-C
        _stop(process)
        raise
    finally:
        thread.join(_K_STOP_SECONDS)
        os.close(reader)
        process.stdout.close()
    if failures:
        raise failures[0]
    return process.returncode, output.decode("utf-8", "replace")


def _load(path: Path) -> dict:
    try:
        return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as failure:
        raise SternaError(f"reading {os.fspath(path)}: {failure}") from failure


class Sterna:
    """The program with its settings.

    program: path or name; None: see find_program. threads: number of threads, 0 or None: all of the machine; results do not depend on it. folder: working folder, relative file names
    start there; None: the current folder. progress: called with a Progress at every step, from another thread. log: called with every line of the program's log. timeout: seconds
    after which TimedOut is raised. Without progress and log nothing is printed: warnings are in the results (key "warnings"), errors in the exceptions.
    """

    def __init__(self, program: Path | None = None, *, threads: int | None = None, folder: Path | None = None, progress: collections.abc.Callable[[Progress], None] | None = None,
                 log: collections.abc.Callable[[str], None] | None = None, timeout: float | None = None):
        self.program = find_program(program)
        self.threads, self.folder, self.progress, self.log, self.timeout = threads, folder, progress, log, timeout

    def _do(self, verb: str, positionals: collections.abc.Iterable[object], options: collections.abc.Mapping[str, object]) -> _Done:
        command = [self.program]
        if self.threads:
            command.append(f"--threads={self.threads}")
        if not self.progress and not self.log:
            command.append("--quiet")
        command += [verb, *(_value_text(entry) for entry in positionals), *_option_arguments(options)]
        messages = _Messages(self.progress, self.log)
        status, output = _execute(command, self.folder, messages, self.progress is not None, self.timeout)
        error = None
        if status:
            kind = {2: UsageError, 3: InvalidMesh, 130: Stopped}.get(status, SternaError)
            error = kind(messages.error or output.strip() or f"{' '.join(command)}: exit status {status}", command, status, output, messages.warnings)
        return _Done(status, output, messages.warnings, error)

    def _must(self, verb: str, positionals: collections.abc.Iterable[object], options: collections.abc.Mapping[str, object]) -> _Done:
        done = self._do(verb, positionals, options)
        if done.error:
            raise done.error
        return done

    def _path(self, name: Path) -> pathlib.Path:
        return pathlib.Path(self.folder or ".", name)

    def _made(self, verb: str, inputs: Paths, outputs: Paths, options: dict) -> dict:
        """Runs a command that writes files; returns the manifest of the first file with "files", "text" and "warnings"."""
        outputs = _paths(outputs, "outputs")
        if not outputs:
            raise TypeError("outputs: expected at least one path")
        done = self._must(verb, _paths(inputs, "inputs"), {"output": outputs, **options})
        return {**self.read_manifest(outputs[0]), "files": [str(self._path(name)) for name in outputs], "text": done.output, "warnings": done.warnings}

    def version(self) -> str:
        """"0.1.0"."""
        command = [self.program, "--version"]
        messages = _Messages(None, None)
        status, output = _execute(command, self.folder, messages, False, self.timeout)
        if status or not output.startswith("sterna "):
            raise SternaError(f"{self.program} is not sterna: --version prints {(output or messages.error).strip()!r}", command, status, output)
        return output.split()[1]

    def run(self, script: Path, arguments: Arguments | None = None, **options: object) -> dict:
        """`sterna run script.lua name=value ...`, with arguments={"name": value} or ["name=value"]. Returns the output of the script ("text") and the warnings. An INVALID mesh is an exception (InvalidMesh)."""
        done = self._must("run", [_one_path(script, "script"), *_script_arguments(arguments)], options)
        return {"text": done.output, "warnings": done.warnings}

    def check_script(self, script: Path, arguments: Arguments | None = None, **options: object) -> list[str]:
        """Returns the mistakes of a script, found without meshing; an empty list if there are none."""
        done = self._do("check-script", [_one_path(script, "script"), *_script_arguments(arguments)], options)
        if done.error and done.status != 2:
            raise done.error
        return re.split(r"\n(?=\S)", done.error.message) if done.error else []

    def mesh(self, surfaces: Paths, outputs: Paths, **options: object) -> dict:
        """`sterna mesh`: prism layers and tetrahedra around surfaces or models. Returns the manifest of the first output (docs/check_json.md has its measures): "verdict", "mesh" with
        numbers of nodes and cells, "layer", "quality", "patches", "options"; and "files", "text", "warnings". Raises InvalidMesh if the mesh is INVALID."""
        return self._made("mesh", surfaces, outputs, options)

    def surface(self, models: Paths, outputs: Paths, **options: object) -> dict:
        """`sterna surface`: triangles on the faces of a model (STEP, IGES, BREP, sumo, CPACS). Returns the surface's manifest: "mesh", "patches", "quality", "options"; and "files",
        "text", "warnings"."""
        return self._made("surface", models, outputs, options)

    def union(self, parts: Paths, outputs: Paths, **options: object) -> dict:
        """`sterna union`: unites closed parts that intersect to one wall. Returns "files", "text", "warnings"."""
        outputs = _paths(outputs, "outputs")
        done = self._must("union", _paths(parts, "parts"), {"output": outputs, **options})
        return {"files": [str(self._path(name)) for name in outputs], "text": done.output, "warnings": done.warnings}

    def convert(self, source: Path, output: Path, **options: object) -> str:
        """`sterna convert source output`: a surface, a volume mesh or a model in another format; returns the output's path."""
        self._must("convert", [_one_path(source, "source"), _one_path(output, "output")], options)
        return str(self._path(output))

    def check(self, mesh: Path, **options: object) -> dict:
        """`sterna check --json`: the proof and the measures of a volume mesh (docs/check_json.md). An INVALID mesh is a result, not an exception: see "verdict"."""
        done = self._do("check", [_one_path(mesh, "mesh")], {"json": True, **options})
        if done.error and done.status != 3:
            raise done.error
        return {**json.loads(done.output), "warnings": done.warnings}

    def check_family(self, meshes: Paths, **options: object) -> dict:
        """`sterna check-family --json`: whether meshes, from coarse to fine, are members of one family. A rule that FAILs is a result, not an exception."""
        done = self._do("check-family", _paths(meshes, "meshes"), {"json": True, **options})
        if done.error and done.status != 3:
            raise done.error
        return {**json.loads(done.output), "warnings": done.warnings}

    def inspect(self, surfaces: Paths, **options: object) -> dict:
        """`sterna inspect --json`: predicts how volume_mesh will treat a surface (docs/inspect.md). Findings that are errors are a result, not an exception: see "errors"."""
        done = self._do("inspect", _paths(surfaces, "surfaces"), {"json": True, **options})
        if done.error and not (done.status == 1 and done.output.lstrip().startswith("{")):
            raise done.error
        return {**json.loads(done.output), "warnings": done.warnings}

    def info(self, file: Path, **options: object) -> dict:
        """`sterna info --json`: content of a file: "kind" (surface, volume mesh, model), "box", "patches" with name, kind and area; for volume meshes "nodes" and "cells"; for
        models "components", "solids", "wings" (span, areas, mean chords), "total". And "manifest": the manifest of sterna beside the file, or None."""
        done = self._must("info", [_one_path(file, "file")], {"json": True, **options})
        manifest = self._path(f"{os.fspath(file)}.json")
        return {**json.loads(done.output), "manifest": _load(manifest) if manifest.is_file() else None, "warnings": done.warnings}

    def draw(self, mesh: Path, picture: Path, **options: object) -> str:
        """`sterna draw mesh -o picture.png`; returns the picture's path."""
        self._must("draw", [_one_path(mesh, "mesh")], {"output": _one_path(picture, "picture"), **options})
        return str(self._path(picture))

    def report(self, mesh: Path, page: Path, **options: object) -> str:
        """`sterna report mesh -o page.html`; returns the page's path. Also works for an INVALID mesh; the page shows the invalid locations."""
        done = self._do("report", [_one_path(mesh, "mesh")], {"output": _one_path(page, "page"), **options})
        if done.error and done.status != 3:
            raise done.error
        return str(self._path(page))

    def series(self, script: Path, name: str, arguments: Arguments | None = None, *, must_succeed: bool = False, **options: object) -> dict:
        """`sterna run` of a script with `series{ "NAME", ... }` (docs/series.md): returns NAME/series.json, with one entry per case in "cases".

        Cases that failed, were killed or are INVALID are results; with must_succeed they raise CaseFailure. Other errors of the script raise SternaError. Complete cases of an
        earlier run are kept, so a second call continues an interrupted series.
        """
        table = self._path(_one_path(name, "name")) / "series.json"
        begin = time.time_ns()
        done = self._do("run", [_one_path(script, "script"), *_script_arguments(arguments)], options)
        is_written = table.is_file() and table.stat().st_mtime_ns >= begin - 10**9  # clocks of file systems are coarse
        result = self.read_series(name) if is_written else None
        bad = [case for case in result["cases"] if case["status"] != "done" or case.get("verdict", "VALID") != "VALID"] if result else []
        if done.error and not (bad and done.status in (1, 3)):
            raise done.error
        if result is None:
            raise SternaError(f"{os.fspath(script)} ended without a series {name!r}: there is no new {table}")
        if bad and must_succeed:
            lines = [f"  {case['name']}: " + (case.get("error", {}).get("message") or case.get("verdict") or case["status"]) for case in bad]
            raise CaseFailure(f"series {name}: {len(bad)} of {len(result['cases'])} cases are not VALID\n" + "\n".join(lines), bad)
        return {**result, "text": done.output, "warnings": done.warnings}

    def read_series(self, folder: Path) -> dict:
        """Returns the table of a series that was run: FOLDER/series.json."""
        return _load(self._path(folder) / "series.json")

    def read_manifest(self, file: Path) -> dict:
        """Returns FILE.json, which sterna writes beside each output file: program, inputs with hashes, options, patches, counts, quality."""
        return _load(self._path(f"{os.fspath(file)}.json"))


def _function(name: str):
    method = getattr(Sterna, name)

    def call(*arguments, sterna: Sterna | None = None, **options):
        return getattr(sterna or Sterna(), name)(*arguments, **options)

    call.__name__ = call.__qualname__ = name
    call.__doc__ = f"{method.__doc__}\n\nRuns Sterna(), or `sterna` if given."
    return call


# Each method also as a function, with the program that find_program() finds.
check, check_family, check_script, convert, draw, info = map(_function, ("check", "check_family", "check_script", "convert", "draw", "info"))
inspect, mesh, read_manifest, read_series, report = map(_function, ("inspect", "mesh", "read_manifest", "read_series", "report"))
run, series, surface, union, version = map(_function, ("run", "series", "surface", "union", "version"))
