# SPDX-License-Identifier: BSD-3-Clause
"""Sections of Markdown files as HTML pages: of Markdown, what README and Documentation use."""
import html
import os
import re
import struct
import sys

TABLE_LINE = re.compile(r"\|.*\|$")
ITEM = re.compile(r"(?:- |\d+\. )")
TABLE_WIDTH = 650  # pixels that pictures in a table share; what is shrunk becomes hard to read


def anchor(heading):
    """The anchor that Markdown viewers give a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def png_width(path):
    with open(path, "rb") as file:
        return struct.unpack(">I", file.read(20)[16:])[0]


def sections(text):
    """Yields heading and body of each section of `text`; what is in fences is no heading."""
    heading, body, fenced = "", [], False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        found = None if fenced else re.match(r"#{1,3} (.*)", line)
        if not found:
            body.append(line)
            continue
        yield heading, "\n".join(body)
        heading, body = found[1], []
    yield heading, "\n".join(body)


class Markdown:
    """Turns a file's Markdown into HTML. `pages`: by path and anchor of what became pages; links to
    other things become plain text. `pictures` collects those seen."""

    def __init__(self, path, pages):
        self.path = os.path.abspath(path)
        self.pages = pages
        self.pictures = set()
        self.room = sys.maxsize  # pixels for a picture

    def sections(self):
        """Yields heading and body of each."""
        with open(self.path, encoding="utf-8") as file:
            yield from sections(file.read())

    def absolute(self, target):
        return os.path.normpath(os.path.join(os.path.dirname(self.path), target))

    def link(self, found):
        text, target = found.groups()
        if target.startswith(("http:", "https:")):
            return f'<a href="{target}">{text}</a>'
        path, _, name = target.partition("#")
        page = self.pages.get((self.absolute(path) if path else self.path, name))
        return f'<a href="{page}">{text}</a>' if page else text

    def picture(self, found):
        path = self.absolute(found[1])
        if not os.path.dirname(path).endswith("gallery"):
            return ""  # plots belong to the measurements, which are not in the help
        self.pictures.add(path)
        width = min(png_width(path), self.room)
        return f'<img src="{os.path.basename(path)}" width="{width}">'

    def inline(self, text):
        """Of one paragraph or table cell."""
        codes = []

        def keep(found):
            codes.append(f"<code>{html.escape(found[1], quote=False)}</code>")
            return f"\0{len(codes) - 1}\0"

        text = html.escape(re.sub(r"`([^`]+)`", keep, text), quote=False)
        text = re.sub(r"!\[[^\]]*\]\(([^)]+)\)", self.picture, text)
        text = re.sub(r"\[([^\]]+)\]\(([^)]+)\)", self.link, text)
        text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
        text = re.sub(r"\*([^*]+)\*", r"<i>\1</i>", text)
        return re.sub("\0(\\d+)\0", lambda found: codes[int(found[1])], text)

    def table(self, lines):
        rows = []
        for number, line in enumerate(lines):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if number == 1:
                continue  # the line below the header
            tag = "th" if number == 0 else "td"
            self.room = TABLE_WIDTH // len(cells)
            rows.append("".join(f"<{tag}>{self.inline(cell)}</{tag}>" for cell in cells))
        self.room = sys.maxsize
        body = "\n".join(f"<tr>{row}</tr>" for row in rows)
        return f'<table border="1" cellspacing="0" cellpadding="4">\n{body}\n</table>'

    def items(self, lines):
        texts = []
        for line in lines:
            if ITEM.match(line):
                texts.append(ITEM.sub("", line, count=1))
            else:
                texts[-1] += " " + line.strip()
        tag = "ul" if lines[0].startswith("- ") else "ol"
        body = "\n".join(f"<li>{self.inline(text)}</li>" for text in texts)
        return f"<{tag}>\n{body}\n</{tag}>"

    def block(self, lines):
        """Of lines between two empty ones."""
        if lines[0].startswith("    "):
            return f"<pre>{html.escape(chr(10).join(line[4:] for line in lines))}</pre>"
        if all(TABLE_LINE.match(line) for line in lines):
            return self.table(lines)
        if ITEM.match(lines[0]):
            return self.items(lines)
        return f"<p>{self.inline(' '.join(lines))}</p>"

    def convert(self, text):
        """HTML of the body of a section."""
        parts = []
        for number, part in enumerate(re.split(r"^```.*$", text, flags=re.MULTILINE)):
            if number % 2:
                parts.append(f"<pre>{html.escape(part.strip())}</pre>")
                continue
            blocks = (block.splitlines() for block in re.split(r"\n\s*\n", part.strip("\n")))
            parts += [self.block(lines) for lines in blocks if lines]
        return "\n".join(parts)
