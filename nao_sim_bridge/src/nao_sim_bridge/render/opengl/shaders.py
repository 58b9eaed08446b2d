"""The programs that OpenGL runs for each vertex and each pixel.

Light: what comes from everywhere (more from above than from below, where it has the colour of the floor), from the
walls of a room, from one lamp with shadows, and from a weak second one on the other side without. A level floor in full
light has the colour that the world file gives it.

Drawing in software takes long to look up a uniform for a pixel, and next to nothing to interpolate one more value.
Programs for pixels therefore have no uniforms: what belongs to the world is written into them as constants, what
belongs to the camera comes from the program for vertices.
"""

from __future__ import annotations

from typing import Mapping, Sequence

HEADER = "#version 430\n"
SCENE = """
layout(std140, binding = 0) uniform Scene {
    mat4 clip;         // from world to the picture, whose first row is the upper one
    mat4 still_matrix; // from world to the two shadow maps
    mat4 moving_matrix;
    vec4 eye;          // and its height over the floor
    vec4 right;        // half the width of the picture 1 m ahead; and the height of a pixel there
    vec4 upwards;      // half the height
    vec4 forward;
    vec4 above;        // plane: what is below is not drawn
};
"""
"""What belongs to the camera; `scene_block.py` writes it."""

SHADOW = """
layout(binding = 0) uniform sampler2DShadow still_map;
layout(binding = 1) uniform sampler2DShadow moving_map;

float near_edge(sampler2DShadow map, vec3 at, float apart) {
    float sum = texture(map, vec3(at.xy + vec2(-0.4, -1.1) * apart, at.z));
    sum += texture(map, vec3(at.xy + vec2(1.1, -0.4) * apart, at.z));
    sum += texture(map, vec3(at.xy + vec2(-1.1, 0.4) * apart, at.z));
    sum += texture(map, vec3(at.xy + vec2(0.4, 1.1) * apart, at.z));
    return sum * 0.25;
}

// How much of the lamp is to be seen from a point whose places in the two maps are given, 0..1.
float lit(vec3 still, vec3 moving) {
    float seen = near_edge(still_map, still, STILL_APART);
    // A loop, because drawing in software leaves out what no pixel needs in loops only.
    int turns = all(lessThan(abs(moving.xy - 0.5), vec2(0.5))) ? 1 : 0;
    for (int turn = 0; turn < turns; turn++)
        seen = min(seen, near_edge(moving_map, moving, MOVING_APART));
    return seen;
}
"""

# --- things ---------------------------------------------------------------------------------------------------------

_THING_VERTEX = """
in vec3 position;
in vec3 normal;
in vec4 color;     // and gloss
in vec2 uv;
in vec4 row_x;     // of the matrix from the thing to the world; one of each instance
in vec4 row_y;
in vec4 row_z;
in vec4 glow;      // its light, and how much of it is light
out vec3 out_of;
out vec3 to_eye;
out vec3 still_at;
out vec3 moving_at;
out vec4 paint;
flat out vec4 shine;
out vec2 spot;
void main() {
    vec4 here = vec4(position, 1.0);
    vec4 at = vec4(dot(row_x, here), dot(row_y, here), dot(row_z, here), 1.0);
    out_of = vec3(dot(row_x.xyz, normal), dot(row_y.xyz, normal), dot(row_z.xyz, normal));
    to_eye = eye.xyz - at.xyz;
    // Off the surface, so that it does not shade itself.
    vec4 off = at + vec4(out_of * (0.004 + 0.008 * (1.0 - clamp(dot(out_of, LAMP), 0.0, 1.0))), 0.0);
    still_at = (still_matrix * off).xyz;
    moving_at = (moving_matrix * off).xyz;
    paint = color;
    shine = glow;
    spot = uv;
    gl_Position = clip * at;
    gl_ClipDistance[0] = dot(above, at);
}
"""

_THING_FRAGMENT = """
in vec3 out_of;
in vec3 to_eye;
in vec3 still_at;
in vec3 moving_at;
in vec4 paint;
flat in vec4 shine;
in vec2 spot;
out vec4 pixel;
void main() {
    vec3 normal = normalize(out_of);
    float seen = lit(still_at, moving_at);
    float rise = dot(normal, UP);
    vec3 light = mix(BOUNCE, AMBIENT, 0.5 + 0.5 * rise) + WALLS * (1.0 - rise * rise);
    light += LAMP_COLOR * (max(dot(normal, LAMP), 0.0) * seen) + vec3(max(dot(normal, FILL), 0.0));
    float gleam = max(dot(normal, normalize(LAMP + normalize(to_eye))), 0.0);
    gleam *= gleam;
    gleam *= gleam;
    gleam *= gleam;
    gleam *= gleam;
    gleam *= gleam * gleam;  // to the 48th
    vec3 color = SURFACE * light + gleam * paint.a * seen * LAMP_COLOR;
    pixel = vec4(mix(BRIGHTER * color, shine.rgb, shine.a), 1.0);
}
"""

_DEPTH_VERTEX = """
uniform mat4 to_map;
in vec3 position;
in vec4 row_x;
in vec4 row_y;
in vec4 row_z;
void main() {
    vec4 here = vec4(position, 1.0);
    gl_Position = to_map * vec4(dot(row_x, here), dot(row_y, here), dot(row_z, here), 1.0);
}
"""

# --- floor and sky --------------------------------------------------------------------------------------------------

_BACKDROP_VERTEX = """
out vec3 ray;
flat out vec4 from;        // eye, and its height over the floor
flat out float pixel_size; // 1 m ahead
// Places in the shadow maps: of the eye, and 1 m farther along the ray.
flat out vec3 still_eye;
flat out vec3 moving_eye;
out vec3 still_step;
out vec3 moving_step;
void main() {
    // One triangle that covers the picture, behind everything. The first row is the upper one: Y is down.
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    ray = forward.xyz + corner.x * right.xyz - corner.y * upwards.xyz;
    from = eye;
    pixel_size = right.w;
    vec4 off = vec4(eye.xyz + 0.004 * UP, 1.0);
    still_eye = (still_matrix * off).xyz;
    moving_eye = (moving_matrix * off).xyz;
    still_step = mat3(still_matrix) * ray;
    moving_step = mat3(moving_matrix) * ray;
    gl_Position = vec4(corner, 1.0, 1.0);
}
"""

_BACKDROP_FRAGMENT = """
in vec3 ray;
flat in vec4 from;
flat in float pixel_size;
flat in vec3 still_eye;
flat in vec3 moving_eye;
in vec3 still_step;
in vec3 moving_step;
out vec4 pixel;
void main() {
    float slope = dot(ray, UP);
    float height = from.w;
    vec3 sky = mix(HORIZON, TOP, clamp(slope * 1.6, 0.0, 1.0));
    if (slope >= -1e-4 || height <= 0.0) {
        pixel = vec4(sky, 1.0);
        return;
    }
    float scale = -height / slope;
    vec2 point = from.xy + scale * ray.xy;
    // Edges of tiles as soft as a pixel is wide there, and one colour where tiles are smaller than pixels.
    float width = scale * pixel_size;
    float deep = width * scale / height;
    vec2 wave = (abs(fract(point / (2.0 * TILE) + 0.25) - 0.5) - 0.25) * 2.0 * TILE;
    vec2 side = clamp(wave / max(0.5 * width + 0.25 * deep, 1e-4), -1.0, 1.0);
    float contrast = clamp(1.6 - 3.0 * deep / TILE, 0.0, 1.0);
    vec3 ground = mix(EVEN_TILE, ODD_TILE, 0.5 - 0.5 * side.x * side.y * contrast);
    ground *= mix(SHADE, vec3(1.0), lit(still_eye + scale * still_step, moving_eye + scale * moving_step));
    float far = scale / HAZE;
    pixel = vec4(mix(HORIZON, ground, exp(-far * far)), 1.0);
}
"""

# --- the light around lamps -----------------------------------------------------------------------------------------

_HALO_VERTEX = """
in vec4 place;           // and radius
in vec3 light;
out vec2 corner;
flat out vec3 color;
void main() {
    corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    color = light;
    vec3 to_eye = eye.xyz - place.xyz;
    float far = length(to_eye);
    float radius = max(place.w, 3.0 * right.w * far);
    // In front of what carries the lamp.
    vec3 middle = place.xyz + to_eye / far * min(0.9 * radius, 0.5 * far);
    vec3 aside = corner.x * normalize(right.xyz) + corner.y * normalize(upwards.xyz);
    gl_Position = clip * vec4(middle + radius * aside, 1.0);
}
"""

_HALO_FRAGMENT = """
in vec2 corner;
flat in vec3 color;
out vec4 pixel;
void main() {
    float fall = max(1.0 - dot(corner, corner), 0.0);
    pixel = vec4(color * fall * fall, 1.0);
}
"""


def constants(values: Mapping[str, float | Sequence[float]]) -> str:
    """Numbers and vectors of three as constants of a program."""
    lines = []
    for name, value in values.items():
        if isinstance(value, (int, float)):
            lines.append(f"const float {name} = {float(value)!r};\n")
        else:
            x, y, z = (float(part) for part in value)
            lines.append(f"const vec3 {name} = vec3({x!r}, {y!r}, {z!r});\n")
    return "".join(lines)


def sources(values: Mapping[str, float | Sequence[float]]) -> dict[str, tuple[str, str]]:
    """The programs for vertices and for pixels by name, with constants as of `scene_block.world_constants`."""
    known = HEADER + constants(values)
    things = known + SCENE + _THING_VERTEX
    plain = _THING_FRAGMENT.replace("SURFACE", "paint.rgb")
    covered = _THING_FRAGMENT.replace("SURFACE", "texture(picture, spot).rgb")
    return {
        "thing": (things, known + SHADOW + plain),
        "covered": (things, known + "layout(binding = 2) uniform sampler2D picture;\n" + SHADOW + covered),
        "depth": (HEADER + _DEPTH_VERTEX, HEADER + "void main() {}\n"),
        "backdrop": (known + SCENE + _BACKDROP_VERTEX, known + SHADOW + _BACKDROP_FRAGMENT),
        "halo": (HEADER + SCENE + _HALO_VERTEX, HEADER + _HALO_FRAGMENT),
    }
