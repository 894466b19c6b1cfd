# SPDX-License-Identifier: BSD-3-Clause
"""Every proxy and every property that the plugin adds is documented, and the proxies exist."""
import glob
import os
import xml.etree.ElementTree as ElementTree

from paraview import servermanager, simple
from pvtest import check, load_plugin

load_plugin()
definitions = servermanager.ProxyManager().SMProxyManager


def documented(element):
    text = element.find("Documentation")
    return text is not None and len((text.text or "").split()) >= 4


properties = 0
files = sorted(glob.glob(os.path.join(os.environ["INR_XML"], "*.xml")))
check(len(files) >= 4, "found only", files)
for path in files:
    for group in ElementTree.parse(path).getroot():
        for proxy in group:
            if proxy.tag == "Extension":
                continue
            name = proxy.get("name")
            check(documented(proxy), name, "is not documented")
            check(
                definitions.GetProxyDefinition(group.get("name"), name) is not None,
                name, "is not known to ParaView",
            )
            for item in proxy:
                if item.tag.endswith("Property"):
                    properties += 1
                    check(documented(item), name, item.get("name"), "is not documented")
                    if item.tag == "IdTypeVectorProperty":  # ParaView 5.11 has no widget for it
                        shown = item.get("information_only") != "1"
                        check(not shown, name, item.get("name"), "is not in the panel")
print(properties, "properties are documented")
check(properties >= 20, "only", properties, "properties found")

# Each command and getter named in the XML exists, or ParaView would say so here.
for make in (simple.INRReader, simple.INRDecode, simple.INRSlice, simple.INRContour):
    make()
