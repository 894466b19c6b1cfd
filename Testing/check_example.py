# SPDX-License-Identifier: BSD-3-Clause
"""Runs an example as a user does: without arguments, with a file that is no model, with a folder that
is not there, and with a model.

    check_example.py MODEL.inr PICTURE COMMAND...
"""
import os
import re
import subprocess
import sys

model, picture, *command = sys.argv[1:]


def run(*arguments):
    done = subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=200)
    return done.returncode, done.stdout + done.stderr


def covered_part():
    """Of the pixels, those that differ from the corner's."""
    from PIL import Image

    image = Image.open(picture).convert("RGB")
    pixels = list(image.getdata())
    return sum(pixel != pixels[0] for pixel in pixels) / len(pixels)


if os.path.exists(picture):
    os.remove(picture)
status, text = run()
assert status != 0 and "usage" in text.lower(), (status, text)
status, text = run(__file__, picture)
assert status != 0 and os.path.basename(__file__) in text, (status, text)
assert not os.path.exists(picture), "a picture of what is no model"
nowhere = os.path.join(picture + ".missing", os.path.basename(picture))
status, text = run(model, nowhere)
assert status != 0 and nowhere in text, (status, text)

status, text = run(model, picture)
print(text)
assert status == 0, status
if picture.endswith(".png"):
    covered = covered_part()
    assert re.search(r"\.png: .* on \w", text), "it does not say what drew"
else:  # no library of ours in Python reads OpenEXR; the program says what it drew
    assert os.path.getsize(picture) > 10000, os.path.getsize(picture)
    covered = float(re.search(r"(\d+) % covered", text)[1]) / 100
print(f"{covered:.1%} of the picture are covered")
assert 0.15 < covered < 0.6, covered
