"""pack.py PAGE.html PAGE.css SCRIPT.js ... MODULE.js MODULE.wasm FONT.woff LIBRARIES OUT.html:
all in one file, the program and the licences as gzip in base64.  The same input gives
the same file."""
import base64
import gzip
import pathlib
import sys

page, style, *scripts, module, wasm, font, libraries, out = map(pathlib.Path, sys.argv[1:])

# Whose work is in the page, and under which licence.
DEBIAN = "/usr/share/common-licenses/"
PARTS = (
    ("elasto", ["LICENSE"]),
    ("CHOLMOD, AMD and COLAMD, of SuiteSparse 5.12",
     [f"sources/suitesparse/{part}/Doc/License.txt"
      for part in ("CHOLMOD", "AMD", "COLAMD")]),
    ("FreeType 2.12.1", ["sources/freetype/docs/FTL.TXT"]),
    ("libpng 1.6.39", ["sources/libpng1.6/LICENSE"]),
    ("zlib 1.2.13", ["sources/zlib/zlib.h"]),
    ("DejaVu 2.37 and DejaVu Math TeX Gyre, cut down",
     ["/usr/share/doc/fonts-dejavu-extra/copyright"]),
    ("musl, and emscripten 3.1.6 (MIT, (c) 2010-2014 its authors)",
     ["/usr/share/emscripten/system/lib/libc/musl/COPYRIGHT"]),
    ("GNU General Public License 2", [DEBIAN + "GPL-2"]),
    ("GNU Lesser General Public License 2.1", [DEBIAN + "LGPL-2.1"]),
)
ABOUT = """This page is elasto as a whole; CHOLMOD's module Supernodal in it is
under the GNU General Public License 2 or later, and so the page is.  Its sources
are those of elasto, whose command `make web` makes it, and of the Debian 12
packages suitesparse, freetype, libpng1.6, zlib and fonts-dejavu, unchanged.
"""


def licence(name):
    path = pathlib.Path(name)
    path = libraries / path if name.startswith("sources/") else path
    text = path.read_text(encoding="utf-8", errors="replace")
    return text.split("*/")[0] if name.endswith(".h") else text


def script(path):
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")


def packed(data):
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


rule = "=" * 72
notice = ABOUT + "".join(f"\n{rule}\n{title}\n{rule}\n\n" + "\n".join(
    licence(name) for name in names) for title, names in PARTS)
text = page.read_text(encoding="utf-8")
for mark, what in (
        ("/*STYLE*/", style.read_text(encoding="utf-8")),
        ("/*GLUE*/", "".join(map(script, scripts))),
        ("/*MODULE*/", script(module)),
        ("/*LICENCES*/", packed(notice.encode())),
        ("/*WASM*/", packed(wasm.read_bytes())),
        ("/*FONT*/", base64.b64encode(font.read_bytes()).decode()),
):
    assert text.count(mark) == 1, mark
    text = text.replace(mark, what)
out.write_text(text, encoding="utf-8")
