"""The camera: Blender's lens, sensor, shift, panoramas and depth of field."""

import math

from .scene_file import point


def export(scene, camera_object, file, report):
    """Writes `[camera]` for the scene's picture.

    Blender's `shift` counts in the longer side of the picture (`sensor_fit`), ours in its width and height.
    """
    data = camera_object.data
    matrix = camera_object.matrix_world
    # A camera's scale does not change its picture.
    turned = matrix.to_quaternion().to_matrix()
    position = matrix.translation
    forward = -turned.col[2]
    camera = file.camera
    camera["position"] = point(position)
    camera["look_at"] = point(position + forward)
    camera["up"] = point(turned.col[1])
    width, height = file.film["size"]
    where = f"camera {camera_object.name}"
    if data.type == "PERSP":
        _perspective(scene, data, camera, width, height)
    elif data.type == "ORTHO":
        view = _view(scene, data, width, height, data.ortho_scale)
        camera["projection"] = "orthographic"
        camera["height"] = view["height"]
        _window(view, camera)
    elif data.type == "PANO":
        _panorama(data, camera, width, height, where, report)
    else:
        report.add(where, f"a camera of the type {data.type}", "a perspective camera stands in its place")
        _perspective(scene, data, camera, width, height)
    if data.clip_start > 0.1001 or data.clip_end < 99.9:
        report.add(where, f"clipping at {data.clip_start:g} and {data.clip_end:g}", "everything before the camera is seen")
    if data.type != "PANO":
        _depth_of_field(scene, camera_object, camera, where, report)
    elif data.dof.use_dof:
        report.add(where, "depth of field of a panorama", "all of it is in focus")
    if getattr(scene.render, "use_multiview", False):
        report.add(where, "a pair of cameras for stereo", "one camera")
    if scene.render.use_motion_blur:
        report.add("render", "motion blur", "everything stands still at the frame")
    if scene.render.use_border:
        border = scene.render
        left, right = round(border.border_min_x * width), round(border.border_max_x * width)
        top, bottom = round((1 - border.border_max_y) * height), round((1 - border.border_min_y) * height)
        crop = f"--crop {left},{top},{right - left},{bottom - top}"
        report.add("render", "a render region", f"the whole picture; `gpt render {crop}` renders the region")


def _view(scene, data, width, height, size):
    """Width and height of the view where the fitted side of it measures `size`, and the shift of its middle."""
    pixel_x, pixel_y = scene.render.pixel_aspect_x, scene.render.pixel_aspect_y
    across, down = width * pixel_x, height * pixel_y
    fit = data.sensor_fit
    horizontal = fit == "HORIZONTAL" or fit == "AUTO" and across >= down
    view_width = size if horizontal else size * across / down
    view_height = view_width * down / across
    return {
        "width": view_width,
        "height": view_height,
        "shift": [data.shift_x * size / view_width, data.shift_y * size / view_height],
        "stretch": pixel_x / pixel_y,
        "horizontal": horizontal,
    }


def _perspective(scene, data, camera, width, height):
    fit = data.sensor_fit
    sensor = data.sensor_height if fit == "VERTICAL" else data.sensor_width
    view = _view(scene, data, width, height, sensor)
    camera["vfov"] = math.degrees(2 * math.atan(view["height"] / (2 * data.lens)))
    _window(view, camera)


def _window(view, camera):
    if any(view["shift"]):
        camera["shift"] = view["shift"]
    if abs(view["stretch"] - 1) > 1e-6:
        camera["stretch"] = view["stretch"]


def _depth_of_field(scene, camera_object, camera, where, report):
    data = camera_object.data
    dof = data.dof
    if not dof.use_dof:
        return
    # Cycles: the radius of the opening is half of the focal length over the f-number; one metre where rays are parallel.
    focal_length = 1.0 if data.type == "ORTHO" else data.lens * 1e-3
    radius = focal_length / (2 * max(dof.aperture_fstop, 1e-5))
    distance = dof.focus_distance
    if dof.focus_object is not None:
        matrix = camera_object.matrix_world
        target = dof.focus_object.matrix_world.translation
        distance = abs((target - matrix.translation).dot(matrix.to_quaternion().to_matrix().col[2]))
    if radius <= 0:
        return
    if dof.aperture_blades >= 3:
        camera["aperture"] = {
            "shape": "polygon",
            "radius": radius,
            "blades": dof.aperture_blades,
            "rotation": math.degrees(dof.aperture_rotation),
        }
    else:
        camera["aperture"] = {"shape": "disk", "radius": radius}
    if abs(dof.aperture_ratio - 1) > 1e-6:
        report.add(where, f"an aperture ratio of {dof.aperture_ratio:g}", "the opening is as wide as high")
    camera["focus_distance"] = max(distance, 1e-5)


def _panorama(data, camera, width, height, where, report):
    # Blender 5 keeps a panorama with the camera, versions before it with Cycles.
    source = data if hasattr(data, "panorama_type") else data.cycles
    kind = source.panorama_type
    if kind == "EQUIRECTANGULAR":
        camera["projection"] = "equirectangular"
        # Blender's longitude grows to the left of what the camera faces; the picture's right edge has the least.
        camera["azimuth"] = [math.degrees(source.longitude_min), math.degrees(source.longitude_max)]
        camera["elevation"] = [math.degrees(source.latitude_min), math.degrees(source.latitude_max)]
    elif kind == "FISHEYE_EQUIDISTANT":
        camera["projection"] = "fisheye"
        camera["mapping"] = "equidistant"
        camera["fov"] = math.degrees(source.fisheye_fov)
        camera["fit"] = "inside"
        if width != height:
            report.add(where, "an equidistant fisheye stretched to a picture that is not square", "the circle stays round")
    elif kind == "FISHEYE_EQUISOLID":
        camera["projection"] = "fisheye"
        camera["mapping"] = "equisolid"
        _equisolid(data, source, camera, width, height, where, report)
    elif kind == "CENTRAL_CYLINDRICAL":
        camera["projection"] = "cylindrical"
        camera["azimuth"] = [
            math.degrees(source.central_cylindrical_range_u_min),
            math.degrees(source.central_cylindrical_range_u_max),
        ]
        radius = source.central_cylindrical_radius
        camera["elevation"] = [
            math.degrees(math.atan(source.central_cylindrical_range_v_min / radius)),
            math.degrees(math.atan(source.central_cylindrical_range_v_max / radius)),
        ]
    else:
        report.add(where, f"a panorama of the type {kind}", "an equirectangular panorama of all directions")
        camera["projection"] = "equirectangular"


def _equisolid(data, source, camera, width, height, where, report):
    """Cycles: r = 2 f sin(θ/2) on the sensor, whose fitted side is the picture's longer one; black past `fisheye_fov`."""
    lens = source.fisheye_lens
    fit = data.sensor_fit
    horizontal = fit == "HORIZONTAL" or fit == "AUTO" and width >= height
    sensor = data.sensor_height if fit == "VERTICAL" else data.sensor_width
    sine = sensor / (4 * lens)
    shown = math.degrees(source.fisheye_fov)
    to_corner = math.hypot(width, height) / (width if horizontal else height)
    whole = math.degrees(4 * math.asin(min(sine * to_corner, 1)))
    if sine * to_corner <= 1 and shown >= whole - 0.01:
        camera["fov"], camera["fit"] = whole, "diagonal"
        return
    camera["fov"] = math.degrees(4 * math.asin(min(sine, 1)))
    camera["fit"] = "width" if horizontal else "height"
    if sine > 1:
        report.add(where, "a fisheye whose circle is smaller than its sensor", "the circle of 360 degrees fills the sensor")
    elif abs(shown - camera["fov"]) > 0.01:
        report.add(where, f"a fisheye that is black past {shown:g} degrees", f"it is black past {camera['fov']:g} degrees")
