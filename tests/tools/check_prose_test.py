#!/usr/bin/python3
"""Plants one finding of each rule of tools/check_prose and sees it refused; names in code, keys and numbers within the allowance are not."""
import pathlib
import subprocess
import sys
import tempfile

TOOL = sys.argv[1]


def run(comment: str, page: str, allowed: str = "", source: str = "geom/a.h") -> tuple[int, str]:
    """The tool's status and output for a repository of one source and one page."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in ((source, comment), ("docs/a.md", page), ("tests/tools/check_prose_allowed.txt", allowed)):
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        done = subprocess.run([TOOL, "--root", folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


GOOD_COMMENT = '/// Returns the area, m^2. Of two triangles the larger one counts.\ndouble area();  ///< "told" in quotation marks and `wish` as a name\nconst char* t = "//told";\n'
GOOD_MESSAGE = r'''#include "wanted by/a.h"
constexpr char k_quote = '"'; const char* k_key = "told"; const char* k_text = "the key \"told\" has a value";
'''
GOOD_PAGE = "# Areas\n\nAreas are computed from the corners.\n\n```lua\nprint(told)\n```\n"
CASES = [
    ("good", GOOD_COMMENT, GOOD_PAGE, "", 0, "0 findings"),
    ("of", "/// Of a triangle.\nint a;\n", GOOD_PAGE, "", 1, "geom/a.h:1"),
    ("of, behind a member", "int a;  ///< of a triangle\n", GOOD_PAGE, "", 1, "geom/a.h:1"),
    ("word", "// What is told of it.\n", GOOD_PAGE, "", 1, "geom/a.h:1"),
    ("allowed", "// What is told of it.\n", GOOD_PAGE, "# not rewritten yet\ngeom tell 1\n", 0, "1 findings"),
    ("more than allowed", "// What is told.\n// Nobody is told.\n", GOOD_PAGE, "geom tell 1\n", 1, "2 x tell, 1 allowed"),
    ("allowance too high", GOOD_COMMENT, GOOD_PAGE, "geom tell 1\n", 0, "higher than needed"),
    ("message", GOOD_MESSAGE, GOOD_PAGE, "", 0, "0 findings"),
    ("word in a message", GOOD_COMMENT + 'const char* m = "it is mended";\n', GOOD_PAGE, "", 1, "geom/a.h:4"),
    ("word behind a line end in a message", r'const char* m = "a\nwanted value";' + "\n", GOOD_PAGE, "", 1, "geom/a.h:1"),
    ("word in a long message", 'const char* m = R"(a\nnobody is told)";\n', GOOD_PAGE, "", 1, "geom/a.h:2"),
    ("word in a message, allowed", 'const char* m = "it is mended";\n', GOOD_PAGE, "geom mend 1\n", 0, "1 findings"),
    ("word in a test's literal", 'const char* m = "it is mended";\n', GOOD_PAGE, "", 0, "0 findings", "tests/a.cpp"),
    ("word in a page", GOOD_COMMENT, GOOD_PAGE + "Faults are mended.\n", "", 1, "docs/a.md:8"),
    ("introduction", GOOD_COMMENT, "# Areas\n\n| a | b |\n", "", 1, "docs/a.md:3"),
]

failed = []
for name, comment, page, allowed, status, text, *source in CASES:
    got = run(comment, page, allowed, *source)
    if got[0] != status or text not in got[1]:
        failed.append(f"{name}: status {got[0]} instead of {status}, {got[1]!r} has no {text!r}")
print("\n".join(failed) if failed else f"{len(CASES)} cases pass")
sys.exit(1 if failed else 0)
