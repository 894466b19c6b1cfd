# SPDX-License-Identifier: BSD-3-Clause
"""Writes the pages of the plugin's help: of README and Documentation what somebody at ParaView's window
needs, and a page for every proxy from the XML that describes it.

    python3 make_help.py FOLDER README.md MARKDOWN... XML...   empties FOLDER first, writes index.html last
    python3 make_help.py --contents XML...                     prints the table of contents for Qt's help
"""
import html
import os
import shutil
import sys

import proxy_pages
from markdown_pages import Markdown, anchor

# The headings that become pages, in this order.
TOPICS = (
    "In ParaView's window",
    "What to turn",
    "What each setting buys and costs",
    "What is in a file",
    "Volumes larger than memory",
    "Time series",
    "Training in parallel",
    "In situ",
    "Filters and exact pictures",
    "With a server",
    "In Python",
    "With an NVIDIA GPU",
    "What it does not do yet",
    "Troubleshooting",
)


def page(title, body):
    title = html.escape(title, quote=False)
    return (
        "<!DOCTYPE html>\n<html><head>"
        '<meta http-equiv="Content-Type" content="text/html; charset=utf-8">'
        f"<title>{title}</title></head>\n<body>\n<h2>{title}</h2>\n{body}\n</body></html>\n"
    )


def topic_pages(documents):
    """Titles and contents of the documents' pages by file name, the README's first words, and the
    pictures that the pages show."""
    found, pages = {}, {}
    markdowns = [Markdown(path, pages) for path in documents]
    for markdown in markdowns:
        for heading, body in markdown.sections():
            found[heading] = markdown, body
            if heading in TOPICS:
                name = anchor(heading)
                pages[markdown.path, name] = name + ".html"
                pages.setdefault((markdown.path, ""), name + ".html")
    topics = {}
    for topic in TOPICS:
        if topic in found:
            markdown, body = found[topic]
            topics[anchor(topic) + ".html"] = topic, markdown.convert(body)
        else:  # a plugin can be built all the same; the test fails
            print(f"make_help.py: no document has a section {topic!r}", file=sys.stderr)
    markdown, body = found["INRVolume"]
    first = markdown.convert(body)
    return topics, first, set().union(*(markdown.pictures for markdown in markdowns))


def proxy_list(files):
    """Titles and contents of the proxies' pages by file name, and a line about each by file name."""
    proxies, exposed = proxy_pages.read_proxies(files)
    pages, briefs = {}, {}
    for proxy in sorted(proxies.values(), key=lambda proxy: proxy.page):
        if proxy.group == proxy_pages.INTERNAL:
            continue
        title = f"{proxy.label} ({proxy.kind()})"
        pages[proxy.page] = title, proxy_pages.proxy_body(proxy, proxies, exposed)
        briefs[proxy.page] = proxy.brief()
    return pages, briefs


def index_body(first, topics, proxies, briefs):
    """HTML of the first page: the README's beginning and links to all others."""
    lines = [first, "<ul>"]
    lines += [f'<li><a href="{name}">{title}</a></li>' for name, (title, _) in topics.items()]
    lines += ["</ul>", "<h3>Reader, writers, filters and representation</h3>", "<ul>"]
    for name, (title, _) in proxies.items():
        lines.append(f'<li><a href="{name}">{title}</a>: {html.escape(briefs[name])}</li>')
    return "\n".join([*lines, "</ul>"])


def print_contents(*files):
    pages = [(anchor(topic) + ".html", topic) for topic in TOPICS]
    pages += [(name, title) for name, (title, _) in proxy_list(files)[0].items()]
    # A ";" would part the text in CMake, so what needs no escape has none.
    escaped = ((name, html.escape(title, quote=False)) for name, title in pages)
    parts = (f'<section title="{title}" ref="{name}"/>' for name, title in escaped)
    print(f'<toc><section title="INRVolume" ref="index.html">{"".join(parts)}</section></toc>')


def write_pages(folder, *files):
    topics, first, pictures = topic_pages([file for file in files if file.endswith(".md")])
    proxies, briefs = proxy_list([file for file in files if file.endswith(".xml")])
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    texts = {name: page(*content) for name, content in {**topics, **proxies}.items()}
    texts["index.html"] = page("INRVolume", index_body(first, topics, proxies, briefs))
    for picture in pictures:
        shutil.copy(picture, folder)
    for name, text in texts.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)


if sys.argv[1] == "--contents":
    print_contents(*sys.argv[2:])
else:
    write_pages(*sys.argv[1:])
