"""The same pictures drawn by OpenGL on the processor (Mesa's llvmpipe), to measure ours against.

Needs moderngl and Mesa's EGL; nothing else of VDS does. Assumes the look `plain`: smooth shading from sun and
sky and nothing else. What is left out of a view (walls, clear glass, all but one level of detail of each
body) is what the renderer leaves out. What moves is skinned beforehand and lies in OpenGL's memory before
the clock starts, as does the set.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from runtime.mesh import MATERIALS
from runtime.raster.film import EXPOSURE, KNEE, to_linear, unexposed
from runtime.raster.panes import divided
from runtime.raster.prepare import CLOSED, SHIFT, Prepared, prepare
from runtime.raster.types import RenderScene, Style, Views, people_of
from runtime.raster.views import left_out, pack_views, with_other_levels
from runtime.rows import unique_rows

NEAR, FAR = 0.03, 500.0
PANE, LAMP = (0.10, 0.12, 0.13), (0.2, 0.2, 0.2)  # what both shine with beside their colour

_LIGHT = """
#version 330
uniform vec3 sun, sun_color, sky, ground, horizon, zenith;
vec3 film(vec3 light) {
    vec3 x = light * EXPOSURE;
    vec3 bent = 1.0 - (1.0 - KNEE) * (1.0 - KNEE) / (max(x, KNEE) - 2.0 * KNEE + 1.0);
    x = clamp(mix(x, bent, step(KNEE, x)), 0.0, 1.0);
    return mix(x * 12.92, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}
""".replace("EXPOSURE", str(EXPOSURE)).replace("KNEE", str(KNEE))

_SHADED = """
vec3 shaded(vec3 normal, vec4 base) {
    vec3 light = mix(ground, sky, normal.z * 0.5 + 0.5) + sun_color * max(dot(normal, sun), 0.0);
    return film(base.rgb * mix(vec3(1.0), light, base.a));
}
"""

#: How surfaces are shaded: (vertex program, fragment program) by name. "vertex" does what our plain look
#: does, light at the corners and colours in between; "pixel" works light out everywhere.
_SURFACES = {
    "pixel": (
        """
#version 330
uniform mat4 clip;
in vec3 position, normal;
in vec4 color;
out vec3 n;
flat out vec4 base;
void main() {
    gl_Position = clip * vec4(position, 1.0);
    n = normal;
    base = color;
}
""",
        _LIGHT
        + _SHADED
        + """
in vec3 n;
flat in vec4 base;
out vec4 picture;
void main() { picture = vec4(shaded(normalize(gl_FrontFacing ? n : -n), base), 1.0); }
""",
    ),
    "vertex": (
        _LIGHT
        + _SHADED
        + """
uniform mat4 clip;
uniform vec3 eye;
in vec3 position, normal;
in vec4 color;
out vec3 paint;
void main() {
    gl_Position = clip * vec4(position, 1.0);
    vec3 n = dot(normal, eye - position) < 0.0 ? -normal : normal;
    paint = shaded(n, color);
}
""",
        """
#version 330
in vec3 paint;
out vec4 picture;
void main() { picture = vec4(paint, 1.0); }
""",
    ),
}

_BACK_VERTEX = """
#version 330
uniform vec3 right, up, forward;
out vec3 ray;
void main() {
    vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    ray = forward + right * at.x + up * at.y;
    gl_Position = vec4(at, 1.0, 1.0);
}
"""

_BACK = """
in vec3 ray;
out vec4 picture;
void main() {
    picture = vec4(film(mix(horizon, zenith, clamp(normalize(ray).z * 1.6, 0.0, 1.0))), 1.0);
}
"""


class NoOpenGLError(Exception):
    """There is no OpenGL here; the message says what is missing."""


class LlvmpipeDrawer:
    """One scene and some moments of it, drawn by OpenGL. shading: by ``pixel`` or by ``vertex``

    Raises NoOpenGLError without moderngl or EGL.
    """

    def __init__(
        self, scene: RenderScene, style: Style, palettes: NDArray[np.float32], shading: str = "vertex"
    ) -> None:
        try:
            import moderngl

            self._gl: Any = moderngl
            self.context = self._gl.create_context(standalone=True, backend="egl")
        except Exception as error:  # without EGL, moderngl raises what it likes
            raise NoOpenGLError(str(error)) from error
        self.name = str(self.context.info["GL_RENDERER"])
        self._surface: Any = self.context.program(*_SURFACES[shading])
        self._back: Any = self.context.program(_BACK_VERTEX, _LIGHT + _BACK)
        self._backdrop = self.context.vertex_array(self._back, [])
        scene, _ = divided(scene)
        prepared = prepare(scene, style)
        self._detail, self._palettes = prepared.detail, palettes
        self._walls, self._people = scene.wall_count, people_of(scene)
        self._light(scene)
        faces = len(prepared.faces)
        of_set = np.arange(prepared.static_faces)
        self._set = self._parts(prepared, of_set, [(prepared.vertices, prepared.normals)], 0)
        moments = [_skinned(prepared, palette) for palette in palettes]
        self._moving = self._parts(
            prepared, np.arange(prepared.static_faces, faces), moments, len(prepared.vertices)
        )
        self._targets: dict[tuple[int, int], Any] = {}

    def _light(self, scene: RenderScene) -> None:
        light = scene.light
        horizon, zenith = unexposed(to_linear(np.array(light.backdrop)))
        values = {
            "sun": light.sun,
            "sun_color": light.sun_color,
            "sky": light.sky,
            "ground": light.ground,
            "horizon": tuple(horizon),
            "zenith": tuple(zenith),
        }
        for program in (self._surface, self._back):
            for name, value in values.items():
                if name in program:
                    program[name].value = tuple(float(v) for v in value)

    def _parts(
        self,
        prepared: Prepared,
        faces: NDArray[np.int64],
        moments: list[tuple[NDArray[np.float32], NDArray[np.float32]]],
        first_vertex: int,
    ) -> list[list[tuple[bool, int, Any]]]:
        """For each moment, vertex arrays with whether their backs are culled and the wall they go with."""
        if not len(faces):
            return [[] for _ in moments]
        corners = prepared.faces[faces] - first_vertex
        colors, _, shade = unique_rows(_bases(prepared)[faces])
        pairs = np.stack([corners.reshape(-1), np.repeat(shade, 3)], axis=1)
        vertices, _, index = unique_rows(pairs)
        index = index.reshape(-1, 3).astype(np.int32)
        closed = ((prepared.info[faces, 1] >> SHIFT) & CLOSED) != 0
        wall = prepared.info[faces, 2]
        tint = self.context.buffer(colors[vertices[:, 1]].astype(np.float32).tobytes())
        ranges = []
        for cull, owner in sorted(set(zip(closed.tolist(), wall.tolist(), strict=True))):
            chosen = index[(closed == cull) & (wall == owner)]
            ranges.append((bool(cull), int(owner), self.context.buffer(chosen.tobytes())))
        out = []
        for position, normal in moments:
            both = np.concatenate([position[vertices[:, 0]], normal[vertices[:, 0]]], axis=1)
            shape = self.context.buffer(both.astype(np.float32).tobytes())
            content = [(shape, "3f 3f", "position", "normal"), (tint, "4f", "color")]
            out.append(
                [
                    (c, w, self.context.vertex_array(self._surface, content, index_buffer=i))
                    for c, w, i in ranges
                ]
            )
        return out

    def draw(self, views: Views, size: tuple[int, int], together: int = 1) -> NDArray[np.uint8]:
        """Every view, uint8 [N, H, W, 3]; see :meth:`sheets` for ``together``."""
        width, height = size
        out = []
        for sheet in self.sheets(views, size, together):
            rows, columns = sheet.shape[0] // height, sheet.shape[1] // width
            tiles = sheet[..., :3].reshape(rows, height, columns, width, 3)[:, ::-1]
            out.append(tiles.swapaxes(1, 2).reshape(-1, height, width, 3).copy())
        return np.concatenate(out)[: len(views.moment)]

    def sheets(self, views: Views, size: tuple[int, int], together: int = 1) -> Iterator[NDArray[np.uint8]]:
        """The views as OpenGL gives them: ``together`` of them side by side, read back at once.

        Yields uint8 [rows * H, columns * W, 4], upside down, in memory that is used again for the next.
        """
        width, height = size
        count = len(views.moment)
        packed = pack_views(views.camera, count, width, height)
        hidden = self._hidden(views, packed)
        clips, corners = _clips(packed), _corners(packed)
        columns = int(np.ceil(np.sqrt(together)))
        whole = (columns * width, -(-together // columns) * height)
        with self.context:  # there may be others
            target = self._target(whole)
            target.use()
            sheet = np.empty((whole[1], whole[0], 4), np.uint8)
            for begin in range(0, count, together):
                target.clear(viewport=(0, 0, *whole))
                for k in range(begin, min(begin + together, count)):
                    column, row = (k - begin) % columns, (k - begin) // columns
                    target.viewport = (column * width, row * height, width, height)
                    self._one(clips[k], corners[k], packed[k], int(views.moment[k]), hidden[k])
                target.read_into(sheet, components=4, viewport=(0, 0, *whole))
                yield sheet

    def _hidden(self, views: Views, packed: NDArray[np.float32]) -> NDArray[np.int32]:
        """What is left out of each view, as ``Prepared.info`` counts walls, int32 [N, W + ...]."""
        moment = np.asarray(views.moment, np.int32)
        level = views.detail
        if level is None:
            level = self._detail.chosen(self._palettes, moment, packed)
        hidden = left_out(views, self._walls, self._people)
        return with_other_levels(hidden, self._detail, level, self._walls)

    def _target(self, size: tuple[int, int]) -> Any:
        if size not in self._targets:
            color, depth = self.context.renderbuffer(size, 4), self.context.depth_renderbuffer(size)
            self._targets[size] = self.context.framebuffer([color], depth)
        return self._targets[size]

    def _one(
        self,
        clip: bytes,
        corner: NDArray[np.float32],
        view: NDArray[np.float32],
        moment: int,
        hidden: NDArray[np.int32],
    ) -> None:
        gl, context = self._gl, self.context
        self._surface["clip"].write(clip)
        if "eye" in self._surface:
            self._surface["eye"].value = tuple(float(v) for v in view[0:3])
        for cull, wall, array in self._set[0] + self._moving[moment]:
            if wall >= 0 and hidden[wall]:
                continue
            context.enable_only(gl.DEPTH_TEST | gl.CULL_FACE if cull else gl.DEPTH_TEST)
            array.render()
        context.enable_only(gl.DEPTH_TEST)
        context.depth_func = "<="
        for name, axis in zip(("right", "up", "forward"), corner, strict=True):
            self._back[name].value = tuple(float(v) for v in axis)
        self._backdrop.render(vertices=3)


def _bases(prepared: Prepared) -> NDArray[np.float32]:
    """What light falls on, float32 [F, 4]: linear colour, and 0 where a pane or a lamp of the set shines."""
    base = np.ones((len(prepared.faces), 4), np.float32)
    base[:, :3] = prepared.color
    material = prepared.info[:, 1] & ((1 << SHIFT) - 1)
    material[prepared.static_faces :] = MATERIALS.index("plain")
    for name, gain, offset in (("glass", 1.5, PANE), ("glow", 2.0, LAMP)):
        shines = material == MATERIALS.index(name)
        base[shines, :3] = prepared.color[shines] * gain + np.array(offset)
        base[shines, 3] = 0.0
    return base


def _skinned(
    prepared: Prepared, palette: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Positions and normals of what moves, in all levels of detail, float32 [K, 3] each."""
    scene = prepared.detail.scene
    blend = np.einsum("vk,vkij->vij", scene.weights, palette[scene.joints])
    position = np.einsum("vij,vj->vi", blend[..., :3], prepared.rest) + blend[..., 3]
    normal = np.einsum("vij,vj->vi", blend[..., :3], prepared.rest_normals)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return position.astype(np.float32), normal.astype(np.float32)


def _clips(packed: NDArray[np.float32]) -> list[bytes]:
    """Clip-from-world matrices of packed views, as OpenGL reads them."""
    eye, right, up, forward = packed[:, 0:3], packed[:, 3:6], packed[:, 6:9], packed[:, 9:12]
    clip = np.zeros((len(packed), 4, 4), np.float32)
    clip[:, 0, :3] = right * (packed[:, 12] / packed[:, 14])[:, None]
    clip[:, 1, :3] = up * (packed[:, 13] / packed[:, 15])[:, None]
    clip[:, 2, :3] = forward * ((FAR + NEAR) / (FAR - NEAR))
    clip[:, 3, :3] = forward
    clip[:, :, 3] = -np.einsum("nij,nj->ni", clip[:, :, :3], eye)
    clip[:, 2, 3] -= 2 * FAR * NEAR / (FAR - NEAR)
    return [np.ascontiguousarray(m.T).tobytes() for m in clip]


def _corners(packed: NDArray[np.float32]) -> NDArray[np.float32]:
    """Right and up scaled to the edges of the picture, and forward, float32 [N, 3, 3]."""
    axes = packed[:, 3:12].reshape(-1, 3, 3).copy()
    axes[:, 0] *= (packed[:, 14] / packed[:, 12])[:, None]
    axes[:, 1] *= (packed[:, 15] / packed[:, 13])[:, None]
    return axes
