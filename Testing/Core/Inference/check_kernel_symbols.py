#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails when an object built for one instruction set could lend code to the others.

    check_kernel_symbols.py NM LIBRARY

Inline functions are emitted as weak symbols, of which the linker keeps any one copy: if a kernel's
object held one outside its own namespace, an AVX-512 copy might serve a processor without it.
"""
import re
import subprocess
import sys

nm, library = sys.argv[1:]
listing = subprocess.run([nm, "-C", library], capture_output=True, text=True, check=True).stdout
kernels, offenders, current = 0, [], ""
for line in listing.splitlines():
    if line.endswith(".o:"):
        current = line[:-1]
        kernels += "Kernel.cpp" in current
    weak = re.match(r"[0-9a-f]+ [WVu] (.*)", line)
    if weak and "Kernel.cpp" in current and not re.search(r"inr::(baseline|avx2|avx512|avx512bf16|amx|amxsplit)::", weak[1]):
        offenders.append(f"{current}: {weak[1]}")
print("\n".join(offenders) or f"{kernels} kernel objects, none shares a symbol")
sys.exit(bool(offenders) or kernels == 0)
