# SPDX-License-Identifier: BSD-3-Clause
"""The plugin's pages in ParaView's help: one for each of its proxies, which says of each property what
the XML says, and none that leads nowhere.

    python3 TestHelp.py INRVolume.qch FOLDER_OF_XML
"""
import glob
import html
import os
import re
import sqlite3
import struct
import sys
import xml.etree.ElementTree as ElementTree
import zlib


def check(condition, *what):
    if not condition:
        print(*what, file=sys.stderr)
        os._exit(1)


def words(text):
    return " ".join(text.split())


def read_pages(path):
    """Contents of a Qt help file by file name; each is a length of four bytes and a zlib stream."""
    rows = sqlite3.connect(path).execute(
        "SELECT Name, Data FROM FileNameTable JOIN FileDataTable ON FileId = Id WHERE Name != ''"
    )
    return {name: zlib.decompress(data[4:]) for name, data in rows}


def contents(path):
    """Names of the pages in the table of contents: Qt's stream of depths, links and titles, integers of
    four bytes and, with their lengths in bytes before them, texts in UTF-16."""
    (data,) = sqlite3.connect(path).execute("SELECT Data FROM ContentsTable").fetchone()
    names, at = [], 0
    while at < len(data):
        at += 4
        for kind in "link", "title":
            (length,) = struct.unpack_from(">I", data, at)
            text = data[at + 4 : at + 4 + length].decode("utf-16-be")
            at += 4 + length
            if kind == "link":
                names.append(os.path.basename(text))
    return names


qch, folder = sys.argv[1:]
pages = read_pages(qch)
texts = {name: data.decode("utf-8") for name, data in pages.items() if name.endswith(".html")}
listed = contents(qch)

proxies = properties = 0
for path in sorted(glob.glob(os.path.join(folder, "*.xml"))):
    for group in ElementTree.parse(path).getroot():
        for proxy in group:
            if proxy.tag == "Extension":
                continue
            page = f"{group.get('name')}.{proxy.get('name')}.html"
            hidden = group.get("name") == "internal_sources"
            if hidden:
                page = "sources.INRReader.html"  # which has its properties but the file's name
            else:
                check(page in listed, page, "is not in the contents", listed)
                documentation = html.escape(words(proxy.find("Documentation").text), quote=False)
                check(documentation.split(". ")[0] in texts[page], page, "lacks the proxy's text")
            proxies += 1
            for item in proxy:
                if not item.tag.endswith("Property") or (hidden and item.get("name") == "FileName"):
                    continue
                properties += 1
                text = html.escape(words(item.find("Documentation").text), quote=False)
                check(text in texts[page], page, "lacks the text of", item.get("name"))
check(proxies >= 9 and properties >= 80, "only", proxies, "proxies,", properties, "properties")
page = "representations.INRVolumeRepresentation.html"
for row in "Opacity Unit Distance<br><code>INRUnitDistance</code>", "Render Mode<br><code>RenderMode</code>":
    check(row in texts[page], page, "has no row", row)

# README's and Documentation's: headings, tables, and links between them.
check("<td><code>RenderMode</code></td>" in texts["what-to-turn.html"], texts["what-to-turn.html"])
check("troubleshooting.html" in listed and listed[0] == "index.html", listed)
check(len(set(listed)) == len(listed), "listed twice", listed)
for name in listed:
    check(len(re.sub(r"<[^>]*>", " ", texts[name]).split()) > 20, name, "is empty")
    check("](" not in texts[name] and "**" not in texts[name], name, "has Markdown in it")
    for target in re.findall(r'(?:href|src)="([^":]+)"', texts[name]):
        check(target in pages, name, "leads to", target)
print(proxies, "proxies and", properties, "properties on", len(listed), "pages")
