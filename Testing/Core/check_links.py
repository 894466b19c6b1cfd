# SPDX-License-Identifier: BSD-3-Clause
"""Every link in a Markdown file leads to a file that there is, and to a heading that it has.

    python3 check_links.py SOURCES
"""
import re
import sys
from pathlib import Path

sources = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(sources / "Plugin/Help"))
sys.dont_write_bytecode = True
from markdown_pages import anchor, sections  # noqa: E402

LINK = re.compile(r"\]\(([^)\s]+)\)")


def anchors(path):
    return {anchor(heading) for heading, _ in sections(path.read_text(encoding="utf-8"))}


def prose(text):
    """Without code, in which brackets mean other things."""
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))


def wrong(file):
    """The links of a file that lead nowhere."""
    for target in LINK.findall(prose(file.read_text(encoding="utf-8"))):
        if target.startswith(("http:", "https:")):
            continue
        path, _, name = target.partition("#")
        leads_to = (file.parent / path).resolve() if path else file
        if not leads_to.exists() or name and name not in anchors(leads_to):
            yield f"{file.relative_to(sources)}: {target}"


ignored = ("build", ".", "_")  # folders that builds and tools make
files = [file for file in sources.rglob("*.md")
         if not any(part.startswith(ignored) for part in file.relative_to(sources).parts[:-1])]
links = [link for file in files for link in wrong(file)]
print(f"{len(files)} files", *links, sep="\n")
sys.exit(1 if links or len(files) < 8 else 0)
