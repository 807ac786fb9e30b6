#!/usr/bin/python3
"""The documents hang together: every link and picture leads somewhere, headings that are linked exist, every page is in the index, commands have the options that are shown.
usage: documents_test.py SOURCE_FOLDER STERNA"""
import functools
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, PROGRAM = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
DOCS = SOURCE / "docs"
PAGES = sorted([*DOCS.rglob("*.md"), SOURCE / "README.md", SOURCE / "ARCHITECTURE.md", SOURCE / "CONTRIBUTING.md"])

HIDDEN = {"--look-in", "--series-case", "--worker"}  # between the program's own processes, not in --help


def without_code(text: str) -> str:
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))


def anchors_of(page: pathlib.Path) -> set[str]:
    """Headings as GitHub and most viewers name them: lower case, - for blanks, nothing else but letters, digits and _."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return {re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-") for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


@functools.cache
def options_of(*verb: str) -> set[str]:
    help_text = subprocess.run([PROGRAM, *verb, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", help_text))


def commands_of(text: str):
    """(verb, options) of each `sterna VERB ...` of a line of its own, or in back ticks."""
    blocks = "\n".join(re.findall(r"^```(?:sh)?\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))
    lines = re.findall(r"^(?:\$ )?(sterna .*)$", re.sub(r"\\\n", " ", blocks), re.MULTILINE) + re.findall(r"`(sterna [^`]*)`", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))
    for line in lines:
        words = re.sub(r'"[^"]*"', "TEXT", re.sub(r" +# .*", "", line)).split()
        verb = next((word for word in words[1:] if re.fullmatch(r"[a-z][a-z_-]*", word)), None)
        if verb:
            yield line, verb, [word.split("=")[0].strip("[],.;:)") for word in words[1:] if re.match(r"\[?--?[a-zA-Z]", word)]


class Documents(unittest.TestCase):
    def test_commands_have_the_options_that_are_shown(self):
        verbs = {word.strip(",") for word in re.findall(r"^  ([a-z][\w-]*(?:, [\w-]+)?)  ", subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout, re.MULTILINE) for word in word.split()}
        n_commands = 0
        for page in PAGES:
            for line, verb, options in commands_of(page.read_text(encoding="utf-8")):
                with self.subTest(page=str(page.relative_to(SOURCE)), command=line):
                    self.assertIn(verb, verbs)
                    for option in options:
                        self.assertIn(option, options_of(verb) | options_of() | HIDDEN)
                n_commands += 1
        self.assertGreater(n_commands, 50)

    def test_links_lead_somewhere(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text(encoding="utf-8"))):
                if re.match(r"[a-z]+:", target):
                    continue
                name, _, anchor = target.partition("#")
                file = (page.parent / name).resolve() if name else page
                with self.subTest(page=str(page.relative_to(SOURCE)), link=target):
                    self.assertTrue(file.exists(), "no such file")
                    if anchor and file.suffix == ".md":
                        self.assertIn(anchor, anchors_of(file))

    def test_named_documents_exist(self):
        for page in PAGES:
            for name in re.findall(r"\bdocs/[\w/]+\.(?:md|png|svg|py)\b", page.read_text(encoding="utf-8")):
                with self.subTest(page=str(page.relative_to(SOURCE)), name=name):
                    self.assertTrue((SOURCE / name).exists())

    def test_every_page_is_in_the_index(self):
        index = (DOCS / "README.md").read_text(encoding="utf-8")
        linked = {(DOCS / target.partition("#")[0]).resolve() for target in re.findall(r"\]\(([^)\s]+)\)", index)}
        for page in DOCS.rglob("*.md"):
            if page.name != "README.md":
                self.assertIn(page.resolve(), linked, f"docs/README.md does not link {page.relative_to(DOCS)}")

    def test_every_picture_is_shown(self):
        text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
        for picture in [*DOCS.rglob("*.png"), *DOCS.rglob("*.svg")]:
            self.assertIn(picture.name, text, f"{picture.relative_to(SOURCE)} is shown nowhere")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
