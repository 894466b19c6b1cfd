# SPDX-License-Identifier: BSD-3-Clause
"""Whatever becomes of a file that is shown, the picture stays and what is computed from it is right
until it is loaded again; then ParaView shows what there is, or says once what is wrong with it."""
import os
import shutil

import numpy as np
from paraview import servermanager, simple
from pvtest import MODEL, Messages, check, data_file, load_plugin, look_at, output_file
from pvtest import picture, psnr, show_view

load_plugin()
NAME = "file-changes.inr"
path = output_file(NAME)
other = output_file("file-changes-other.inr")
if os.path.exists(other):
    os.remove(other)
volume = simple.OpenDataFile(data_file("les_wmag91.vti"))
rates = {"SampleRate" + axis: 3 for axis in "IJK"}
coarse = simple.ExtractSubset(Input=volume, VOI=[0, 90] * 3, **rates)
writer = servermanager.writers.INRWriter(Input=coarse, FileName=other)
writer.SetPropertyWithName("MaximumSteps", 50)
writer.UpdatePipeline()

shutil.copy(MODEL, path)
view = show_view((200, 150))
reader = simple.OpenDataFile(path)
display = simple.Show(reader, view)
look_at(view)
good = picture(view, "file-changes-good")
check(good.std() > 0.01, "nothing is shown")
points = reader.GetDataInformation().GetNumberOfPoints()
brick_size = 12


def check_intact(what):
    """Bricks that were not decoded before show the model that was opened, and filters see it."""
    global brick_size
    brick_size += 1
    with Messages() as messages:
        display.BrickSize = brick_size
        view.SMProxy.InteractiveRender()
        again = picture(view, "file-changes-again")
        block = simple.INRDecode(Input=reader, VolumeOfInterest=[0, 9, 0, 9, 0, 9])
        block.UpdatePipeline()
        decoded = block.GetDataInformation().GetNumberOfPoints()
        simple.Delete(block)
    check(messages.errors() == 0, what, "gave", messages.text)
    same = np.abs(again - good).max() < 1.5 / 255
    check(same, what, "changes the picture:", psnr(again, good), "dB")
    check(decoded == 1000, what, "gives", decoded, "decoded voxels")


def load_again():
    with Messages() as messages:
        simple.ReloadFiles(reader)
        simple.Render(view)
        simple.Render(view)
    return messages


def truncate():
    with open(path, "r+b") as file:
        file.truncate(1000)


def damage():
    with open(path, "r+b") as file:
        file.seek(os.path.getsize(path) // 2)
        file.write(bytes(64))


def write_other_over_it():
    with open(other, "rb") as source, open(path, "r+b") as file:
        file.write(source.read())
        file.truncate()


def put_other_in_its_place():
    shutil.copy(other, path + ".new")
    os.replace(path + ".new", path)


check_intact("nothing")
for change, word in ((truncate, NAME), (lambda: os.remove(path), NAME), (damage, "checksum")):
    change()
    check_intact("a bad file")
    messages = load_again()
    check(messages.errors() == 1, "loading a bad file again gave", messages.text)
    check(word in messages.text and NAME in messages.text, "unclear:", messages.text)
    check(reader.GetDataInformation().GetNumberOfPoints() == 0, "a bad file has points")
    shutil.copy(MODEL, path)
    messages = load_again()
    check(messages.errors() == 0, "loading a file that is put right gave", messages.text)
    check_intact("a file that is put right")

for change in (write_other_over_it, put_other_in_its_place):
    change()
    check_intact("another file")
    messages = load_again()
    check(messages.errors() == 0, "loading another file gave", messages.text)
    check(reader.GetDataInformation().GetNumberOfPoints() == 31**3, "the other file is not shown")
    different = np.abs(picture(view, "file-changes-other") - good).max() > 0.1
    check(different, "the other file looks the same")
    shutil.copy(MODEL, path)
    load_again()
    check(reader.GetDataInformation().GetNumberOfPoints() == points, "the file does not come back")
    check_intact("a file that came back")
