# SPDX-License-Identifier: BSD-3-Clause
"""Pictures in which the pieces that processes have of a volume have no order, or light goes from one to
another: traced paths, volumes that are turned, several of them, among translucent surfaces that lie in one
piece or cross several."""
from paraview import simple
from pvtest import MODEL, check, check_same, look_at, picture, show_ball, show_balls, show_model

# As the surfaces are, in several processes' pictures.
COMPOSED = ["paths over glass", "isosurfaces over glass", "turned over glass 0", "turned over glass 1"]
COMPOSED += ["two over glass", "the other over glass", "the other elsewhere"]
COMPOSED += ["bright paths before surfaces"]  # limited so that roundings do not overflow


def path_of(where, name):
    return f"server-glass-{where}-{name}"


def pictures(where, chosen=None):
    """The view, the volume's display and the pictures by name, which are saved, too: the chosen ones."""
    result = {}
    view, display = show_model((160, 130))
    glass = show_balls(view)
    # One that reaches from piece to piece, another one in it.
    glass += [show_ball(view, [45, 45, 45], 36), show_ball(view, [50, 40, 60], 14)]
    for ball in glass[3:]:
        ball.DiffuseColor = [0.9, 0.5, 0.2]

    def take(name):
        if chosen is None or name in chosen:
            result[name] = picture(view, path_of(where, name))

    def make_glass(opacity):
        for ball in glass[::2] + glass[3:4]:
            ball.Opacity = opacity

    glass[3].Visibility = glass[4].Visibility = 0
    display.SamplesPerPixel, display.MaximumBounces = 16, 3
    display.AmbientLight = [0.2, 0.2, 0.2]  # dim: no path is brighter than white
    display.RenderMode = "Path Tracing"
    take("paths")
    display.AmbientLight = [3, 4, 5]  # brighter than any window
    take("bright paths before surfaces")
    display.AmbientLight = [0.2, 0.2, 0.2]
    display.INRUseCropping = 1
    display.INRCroppingScale = [0.6, 1, 0.5]
    display.INRCroppingOrigin = [10, 0, 5]
    take("cropped paths")
    display.INRUseCropping = 0
    glass[3].Visibility = glass[4].Visibility = 1
    make_glass(0.5)
    take("paths over glass")
    display.RenderMode = "Ray Marching"
    display.INRBlendMode = "Isosurface"
    display.INRIsosurfaceValues = [45, 80]
    take("isosurfaces over glass")
    display.INRBlendMode = "Composite"
    camera = view.GetActiveCamera()
    display.Origin = [45, 45, 45]
    for side in range(2):
        display.Orientation = [20, 30 + 100 * side, 40]
        take(f"turned over glass {side}")
        camera.Azimuth(120)
    make_glass(1)
    glass[3].Visibility = glass[4].Visibility = 0
    take("turned")
    # Sines of right angles are not 0, and pieces' boxes are to meet all the same.
    sheet = simple.Show(simple.Plane(Origin=[-20, -20, 41], Point1=[120, -20, 49], Point2=[-20, 120, 37]), view)
    for angles in ([0, 180, 0], [90, 0, 0], [0, 90, 0]):
        display.Orientation = angles
        take(f"turned by {max(angles)} degrees {angles.index(max(angles))}")
    sheet.Visibility = 0
    look_at(view)
    display.Origin = display.Orientation = [0, 0, 0]
    second = simple.Show(simple.INRReader(FileName=MODEL), view)
    second.Position = [60, 10, 0]
    second.SamplesPerPixel, second.MaximumBounces = 16, 2
    second.AmbientLight = [0.2, 0.2, 0.2]
    display.ScatteringAlbedo = second.ScatteringAlbedo = 0.5
    display.RenderMode = second.RenderMode = "Path Tracing"
    take("two traced")
    display.RenderMode = "Ray Marching"
    take("one traced")
    second.Visibility = 0
    for ball in glass:
        ball.Visibility = 0
    display.RenderMode = "Path Tracing"
    view.Background = [0.1, 0, 0.3]
    display.AmbientLight = [3, 4, 5]
    take("bright paths")
    view.Background = [1, 1, 1]
    take("bright paths on white")
    view.Background = [0, 0, 0]
    display.RenderMode = "Ray Marching"
    display.Shade = 1
    display.Specular = 0.8
    another = simple.AddLight(view=view)
    another.Coords = "Camera"
    take("lit")
    simple.RemoveLight(another)
    display.Shade, display.Specular = 0, 0
    view.Background = [1, 1, 1]
    for ball in glass:
        ball.Visibility = 1
    second.Visibility = 1
    second.RenderMode = "Ray Marching"
    glass[3].Visibility = glass[4].Visibility = 1
    make_glass(0.5)
    take("two over glass")
    display.Visibility = 0  # what surfaces are shared out by is the other one's place now
    take("the other over glass")
    second.Position = [-20, 30, 20]
    take("the other elsewhere")
    display.Visibility, second.Visibility = 1, 0
    return view, display, result


def check_parallel(found, expected):
    """Several processes have drawn, by name, what one has."""
    for name, image in expected.items():
        check(image.std() > 0.03, name, "shows nothing", image.std())
    check_same(found, expected, COMPOSED)
