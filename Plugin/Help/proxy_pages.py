# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView's descriptions of the plugin's proxies say, as HTML pages, named as ParaView's help
looks for them: GROUP.NAME.html."""
import html
import re
import xml.etree.ElementTree as ElementTree

INTERNAL = "internal_sources"  # nobody sees proxies of this group
KINDS = {
    "sources": "reader",
    "filters": "filter",
    "writers": "writer",
    "extract_writers": "extractor",
    "screenshot_writers": "screenshot",
    "representations": "representation",
}


def words(text):
    return " ".join((text or "").split())


class Proxy:
    """One proxy: `group`, `name`, and the XML element that describes it."""

    def __init__(self, group, element):
        self.group = group
        self.element = element
        self.name = element.get("name")
        self.label = element.get("label", self.name)
        self.page = f"{group}.{self.name}.html"
        self.documentation = element.find("Documentation")
        self.properties = {
            item.get("name"): item for item in element if item.tag.endswith("Property")
        }

    def kind(self):
        return KINDS[self.group]

    def brief(self):
        return words(self.documentation.get("short_help")) or self.paragraphs()[0]

    def paragraphs(self):
        parts = [self.documentation.get("long_help", ""), *self.documentation.text.split("\n\n")]
        return [words(part) for part in parts if part.strip()]


def read_proxies(paths):
    """All proxies of the files, and what extensions of ParaView's own call the properties of a proxy:
    {(group, name): {property: name that it is exposed under}}."""
    proxies, exposed, labels = {}, {}, {}
    for path in paths:
        for group in ElementTree.parse(path).getroot():
            for element in group:
                if element.tag != "Extension":
                    proxy = Proxy(group.get("name"), element)
                    proxies[proxy.group, proxy.name] = proxy
                for part in element.iter("SubProxy"):
                    target = part.find("Proxy")
                    key = target.get("proxygroup"), target.get("proxyname")
                    exposed.setdefault(key, {}).update(
                        (item.get("name"), item.get("exposed_name", item.get("name")))
                        for item in part.iter("Property")
                    )
                for part in element.iter("RepresentationType"):
                    labels[part.get("subproxy")] = part.get("text")
    for proxy in proxies.values():
        proxy.label = labels.get(proxy.name, proxy.label)
    return proxies, exposed


def shown_properties(proxy, proxies):
    """(name, element) of what somebody may set or read of a proxy, its parts' properties included."""
    for part in proxy.element.iter("SubProxy"):
        target = part.find("Proxy")
        inner = proxies[target.get("proxygroup"), target.get("proxyname")]
        for item in part.find("ExposedProperties").iter("Property"):
            if item.get("name") in inner.properties:
                yield item.get("name"), inner.properties[item.get("name")]
    yield from proxy.properties.items()


def restrictions(item):
    """What values a property takes, as HTML."""
    if item.get("information_only") == "1":
        return "read only"
    entries = [entry.get("text") for entry in item.iter("Entry")]
    if entries:
        return "<br>".join(html.escape(entry) for entry in entries)
    if item.find("BooleanDomain") is not None:
        return "0 or 1"
    for bounds in item.findall("DoubleRangeDomain") + item.findall("IntRangeDomain"):
        low, high = ((bounds.get(end) or "").split(" ")[0] for end in ("min", "max"))
        if low and high:
            return f"{low} to {high}"
        if low:
            return f"{low} or more"
    return ""


def default(item):
    """A property's default, in the words of its choices; as HTML."""
    value = item.get("default_values", "")
    for entry in item.iter("Entry"):
        if entry.get("value") == value:
            value = entry.get("text")
    return html.escape(value)


def in_panel(name):
    """What ParaView's panel calls a property without a label: its name with spaces."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)


def property_row(name, item, exposed):
    in_scripts = exposed.get(name, name)
    title = html.escape(item.get("label", in_panel(in_scripts)))
    if title != in_scripts:
        title += f"<br><code>{html.escape(in_scripts)}</code>"
    text = html.escape(words(item.find("Documentation").text), quote=False)
    cells = (title, text, default(item), restrictions(item))
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def proxy_body(proxy, proxies, exposed):
    """HTML of a proxy's page, below its heading."""
    text = "".join(f"<p>{html.escape(part, quote=False)}</p>\n" for part in proxy.paragraphs())
    names = exposed.get((proxy.group, proxy.name), {})
    rows = [property_row(name, item, names) for name, item in shown_properties(proxy, proxies)]
    widths = {"Property": 24, "What it does": 50, "Default": 13, "Values": 13}
    heads = "".join(f'<th width="{width}%">{head}</th>' for head, width in widths.items())
    table = "\n".join([f"<tr>{heads}</tr>", *rows])
    return f'{text}<table border="1" cellspacing="0" cellpadding="4" width="100%">\n{table}\n</table>'
