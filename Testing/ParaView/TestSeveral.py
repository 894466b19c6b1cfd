# SPDX-License-Identifier: BSD-3-Clause
"""Several volumes and several views at once, and what users do with them."""
import numpy as np
from paraview import simple
from paraview.modules.vtkRemotingMisc import vtkSMProxyClipboard
from pvtest import MODEL, Messages, check, load_plugin, look_at, picture, psnr, show_view

load_plugin()


def rgba(view, name, *shown):
    """What is shown alone, premultiplied, from pictures before black and white."""
    for reader in readers:
        simple.Show(reader, view) if reader in shown else simple.Hide(reader, view)
    pictures = []
    for grey in (0, 1):
        view.Background = [grey] * 3
        pictures.append(picture(view, f"several-{name}-{grey}"))
    alpha = 1 - np.mean(pictures[1] - pictures[0], axis=2, keepdims=True)
    return np.concatenate([pictures[0], alpha], axis=2)


def over(front, back):
    return front + (1 - front[..., 3:]) * back


def differ(a, b):
    return 255 * np.abs(a - b).mean()


# One behind the other: from either side the nearer one covers the other one.
view = show_view()
readers = [simple.OpenDataFile(MODEL) for _ in range(2)]
displays = [simple.Show(reader, view) for reader in readers]
displays[1].Position = [110, 0, 0]
with Messages() as messages:
    for side in (1, -1):
        view.CameraFocalPoint = [100, 45, 45]
        view.CameraPosition = [100 + side * 420, 130, 120]
        view.CameraViewUp = [0, 0, 1]
        view.GetRenderer().ResetCameraClippingRange()
        name = "right" if side > 0 else "left"
        first = rgba(view, f"{name}-first", readers[0])
        second = rgba(view, f"{name}-second", readers[1])
        both = rgba(view, f"{name}-both", *readers)
        near, far = (second, first) if side > 0 else (first, second)
        check(differ(over(near, far), over(far, near)) > 0.5, "the order does not show")
        check(differ(both, over(near, far)) < 0.3, name, differ(both, over(near, far)),
              "and in the other order", differ(both, over(far, near)))
    # Overlapping: one over the other, whichever, and always the same.
    displays[1].Position = [30, 0, 0]
    simple.Render(view)
    once = rgba(view, "overlapping", *readers)
    first, second = rgba(view, "one", readers[0]), rgba(view, "other", readers[1])
    orders = [differ(once, over(first, second)), differ(once, over(second, first))]
    check(min(orders) < 0.3, "neither lies over the other:", orders)
    check(np.array_equal(once, rgba(view, "overlapping", *readers)), "the order changes")

    # Another view of one of them, cameras linked.
    other = show_view()
    shown = simple.Show(readers[0], other)
    look_at(other)
    simple.AddCameraLink(view, other, "cameras")
    look_at(view)
    simple.Hide(readers[1], view)
    simple.Show(readers[0], view)
    view.Background = [1, 1, 1]
    check(psnr(picture(view, "several-linked-a"), picture(other, "several-linked-b")) > 60,
          "linked cameras show different pictures")
    view.GetActiveCamera().Azimuth(60)
    simple.Render(view)
    check(psnr(picture(view, "several-turned-a"), picture(other, "several-turned-b")) > 60,
          "the linked camera does not follow")
    simple.RemoveCameraLink("cameras")

    # Copy and paste of a display's properties.
    displays[0].SampleDistance, displays[0].LevelOfDetailScale = 0.6, 3
    displays[0].RenderMode, displays[0].SamplesPerPixel = "Path Tracing", 2
    clipboard = vtkSMProxyClipboard()
    check(clipboard.Copy(displays[0].SMProxy), "cannot copy")
    check(clipboard.CanPaste(shown.SMProxy) and clipboard.Paste(shown.SMProxy), "cannot paste")
    shown.UpdateVTKObjects()
    values = [shown.SampleDistance, shown.LevelOfDetailScale, shown.RenderMode]
    check(values == [0.6, 3, "Path Tracing"], "pasted", values)
    camera = [list(view.CameraPosition), list(view.CameraFocalPoint), list(view.CameraViewUp)]
    other.CameraPosition, other.CameraFocalPoint, other.CameraViewUp = camera
    pasted = psnr(picture(view, "several-copied"), picture(other, "several-pasted"))
    check(pasted > 60, "pasted properties give another picture:", pasted)
    shown.RenderMode = displays[0].RenderMode = "Ray Marching"

    # A comparative view shows it in each of its views.
    comparative = simple.CreateView("ComparativeRenderView")
    comparative.ViewSize = [300, 300]
    comparative.Dimensions = [2, 1]
    compared = simple.Show(readers[0], comparative)
    check(compared.Representation == "INR Volume", "compared as", compared.Representation)
    simple.Render(comparative)
    comparative.CameraPosition, comparative.CameraFocalPoint, comparative.CameraViewUp = camera
    simple.Render(comparative)
    cells = picture(comparative, "several-comparative")
    halves = [cells[:, :145], cells[:, 155:]]
    contrasts = [half.std() for half in halves]
    check(min(contrasts) > 0.02, "a view of the comparative one is empty:", contrasts)
    simple.Delete(comparative)

    # A click takes the volume in front, also where that was shown first.
    clicked = show_view((100, 100))
    for shown in readers[:2]:
        simple.Show(shown, clicked)
    look_at(clicked)
    front, back = (simple.GetDisplayProperties(shown, clicked) for shown in readers[:2])
    eye = np.array(clicked.CameraPosition) - np.array(clicked.CameraFocalPoint)
    front.Position = list(0.3 * eye)
    front.ScalarOpacityUnitDistance = back.ScalarOpacityUnitDistance = 0.01
    simple.Render(clicked)
    check(clicked.SMProxy.Pick(50, 50) == front.SMProxy, "the volume behind is picked")
    simple.Delete(clicked)

    # Sources go while others are shown and load.
    simple.Show(readers[1], view)
    view.SMProxy.InteractiveRender()
    simple.Delete(readers[0])
    simple.Render(view)
    check(picture(view, "several-left-over").std() > 0.02, "the other volume is gone, too")
    simple.Delete(readers[1])
    simple.Render(view)
    check(picture(view, "several-none").std() < 1e-6, "a deleted volume is shown")
check(messages.errors() == 0, "reported:", messages.text)
