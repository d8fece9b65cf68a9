"""gpt in Blender: a button that renders the scene by the path tracer gpt and shows the picture, and one that writes its scene file."""

import os
import shutil
import subprocess
import tempfile

import bpy

PICTURE = "gpt"


class GptPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH", default="gpt",
        description="The program gpt; its name alone where it is on the path")
    device: bpy.props.EnumProperty(
        name="Device", default="auto",
        items=[(name, name, "") for name in ("auto", "gpu", "cpu")], description="The device that renders")

    def draw(self, context):
        self.layout.prop(self, "program")
        self.layout.prop(self, "device")


def command(program, scene_path, picture_path, flags, device="auto"):
    """The command that renders: the linear picture as OpenEXR."""
    return [program, "render", scene_path, "-o", picture_path, "--device", device, "--quiet", *flags]


def find(program):
    """The path of the program, or None."""
    program = bpy.path.abspath(program) if program.startswith("//") else os.path.expanduser(program)
    return shutil.which(program)


def shown(path):
    """A rendering as the Blender image "gpt", packed: the file may go."""
    image = bpy.data.images.get(PICTURE)
    if image is not None:
        bpy.data.images.remove(image)
    image = bpy.data.images.load(path)
    image.name = PICTURE
    image.pack()
    image.filepath = ""
    image.use_view_as_render = True
    return image


class RENDER_OT_gpt(bpy.types.Operator):
    """Render the scene by gpt, and show the picture as the image "gpt". Esc stops it"""

    bl_idname = "render.gpt"
    bl_label = "Render by gpt"

    def execute(self, context):
        """Renders and waits for the end, as scripts want it."""
        if not self._start(context):
            return {"CANCELLED"}
        self._process.wait()
        return self._finish(context)

    def invoke(self, context, event):
        if not self._start(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set("gpt renders; Esc stops it")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._process.terminate()
            self._process.wait()
            self._end(context)
            self._remove()
            self.report({"WARNING"}, "gpt was stopped")
            return {"CANCELLED"}
        if event.type != "TIMER" or self._process.poll() is None:
            return {"PASS_THROUGH"}
        self._end(context)
        return self._finish(context)

    def _start(self, context):
        from .scene import export

        addon = context.preferences.addons.get(__package__)
        program = find(addon.preferences.program if addon else os.environ.get("GPT", "gpt"))
        if program is None:
            self.report({"ERROR"}, "The program gpt is not found: set its path in Edit > Preferences > Add-ons > gpt")
            return False
        self._folder = tempfile.mkdtemp(prefix="gpt-")
        path, self._picture = os.path.join(self._folder, "scene.toml"), os.path.join(self._folder, "picture.exr")
        try:
            found, _ = export(context.scene, path)
        except (ValueError, RuntimeError, OSError) as error:
            self._remove()
            self.report({"ERROR"}, f"The scene cannot be exported: {error}")
            return False
        _tell(self, found)
        self._errors = open(os.path.join(self._folder, "errors.txt"), "w+", encoding="utf-8")
        device = addon.preferences.device if addon else "auto"
        self._process = subprocess.Popen(
            command(program, path, self._picture, [], device), stdout=subprocess.DEVNULL, stderr=self._errors)
        return True

    def _finish(self, context):
        try:
            if self._process.returncode != 0:
                self._errors.seek(0)
                self.report({"ERROR"}, f"gpt ended with {self._process.returncode}: {self._errors.read().strip()}")
                return {"CANCELLED"}
            image = shown(self._picture)
        finally:
            self._remove()
        for area in context.screen.areas if context.screen else ():
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
        self.report({"INFO"}, f"Rendered: the image {image.name!r}")
        return {"FINISHED"}

    def _end(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)

    def _remove(self):
        errors = getattr(self, "_errors", None)
        if errors is not None:
            errors.close()
        shutil.rmtree(self._folder, ignore_errors=True)


class EXPORT_OT_gpt(bpy.types.Operator):
    """Write the scene as a scene file of gpt, with its meshes and pictures beside it"""

    bl_idname = "export_scene.gpt"
    bl_label = "Export to gpt"

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    def invoke(self, context, event):
        if not self.filepath:
            self.filepath = os.path.splitext(context.blend_data.filepath or "scene")[0] + ".toml"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        from .scene import export

        try:
            found, _ = export(context.scene, self.filepath)
        except (ValueError, RuntimeError, OSError) as error:
            self.report({"ERROR"}, f"The scene cannot be exported: {error}")
            return {"CANCELLED"}
        _tell(self, found)
        return {"FINISHED"}


def _tell(operator, found):
    """The report's lines in Blender's text "gpt report", and how many there are."""
    text = bpy.data.texts.get("gpt report") or bpy.data.texts.new("gpt report")
    text.clear()
    text.write(str(found) + "\n")
    if found.lines:
        operator.report({"WARNING"}, f"{len(found.lines)} things could not be said: see the text {text.name!r}")


class RENDER_PT_gpt(bpy.types.Panel):
    bl_label = "gpt"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    def draw(self, context):
        self.layout.operator(RENDER_OT_gpt.bl_idname, icon="RENDER_STILL")
        self.layout.operator(EXPORT_OT_gpt.bl_idname, icon="EXPORT")


def _export_menu(menu, context):
    menu.layout.operator(EXPORT_OT_gpt.bl_idname, text="gpt (.toml)")


CLASSES = (GptPreferences, RENDER_OT_gpt, EXPORT_OT_gpt, RENDER_PT_gpt)


def register():
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.TOPBAR_MT_file_export.append(_export_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(_export_menu)
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
