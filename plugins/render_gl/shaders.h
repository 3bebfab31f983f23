// The shaders. Places are relative to the eye, in world axes; colours are linear.
#pragma once

namespace kolize::gl {

inline constexpr const char* version_line = "#version 330 core\n";

// lit(): Blinn-Phong (Blinn 1977) under a sky that is brighter above than below. A light falls off as
// (1 - (d / range)^2)^2: full at its place, without an edge at its range.
inline constexpr const char* lighting_glsl = R"(
struct Light {
    vec4 place_and_range;
    vec4 colour_and_outer;
    vec4 direction_and_inner;
};
layout(std140) uniform Lighting {
    vec3 up;
    int light_count;
    Light lights[8];
};

float brightness(Light light, vec3 to_light) {
    float share = dot(to_light, to_light) / (light.place_and_range.w * light.place_and_range.w);
    float fall = max(1.0 - share, 0.0);
    float outer = light.colour_and_outer.w;
    float along = dot(normalize(-to_light), light.direction_and_inner.xyz);
    float cone = outer < -1.0 ? 1.0 : smoothstep(outer, light.direction_and_inner.w, along);
    return fall * fall * cone;
}

vec3 lit(vec3 place, vec3 normal, vec3 albedo, float gloss) {
    vec3 colour = albedo * (0.16 + 0.08 * dot(normal, up));
    vec3 to_eye = normalize(-place);
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light = lights[i].place_and_range.xyz - place;
        float power = brightness(lights[i], to_light);
        to_light = normalize(to_light);
        float highlight = pow(max(dot(normal, normalize(to_light + to_eye)), 0.0), 40.0);
        float facing = max(dot(normal, to_light), 0.0);
        colour += lights[i].colour_and_outer.rgb * power * facing * (albedo + gloss * highlight);
    }
    return colour;
}
)";

inline constexpr const char* body_vertex_glsl = R"(
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec4 row_x;  // of the placement: turn and scale, then the shift
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 paint;
uniform mat4 clip;
out vec3 place;
out vec3 normal;
out vec3 in_body;  // balls: of radius 1
out vec3 normal_in_body;
flat out vec4 colour;

void main() {
    place = vec3(dot(row_x, vec4(vertex, 1)), dot(row_y, vec4(vertex, 1)), dot(row_z, vec4(vertex, 1)));
    normal = vec3(dot(row_x.xyz, vertex_normal), dot(row_y.xyz, vertex_normal), dot(row_z.xyz, vertex_normal));
    in_body = vertex;
    normal_in_body = vertex_normal;
    colour = paint;
    gl_Position = clip * vec4(place, 1);
}
)";

// Balls (paint.a is 1) are darker in every other octant, so that one sees them spin. A skin is laid on along the three
// axes of the body, its middle on each axis and no side of it mirrored, and blended by the normal.
inline constexpr const char* body_fragment_glsl = R"(
in vec3 place;
in vec3 normal;
in vec3 in_body;
in vec3 normal_in_body;
flat in vec4 colour;
uniform float gloss;
uniform float skin_repeats;  // of the skin's picture in a unit of in_body; 0: the body has no skin
uniform sampler2D skin;
out vec4 pixel;

float octants(vec3 p) {
    vec3 side = clamp(p / max(fwidth(p), vec3(1e-6)), -1.0, 1.0);
    return 0.5 + 0.5 * side.x * side.y * side.z;
}

vec3 painted() { return pow(colour.rgb, vec3(2.2)) * mix(1.0, mix(0.35, 1.0, octants(in_body)), colour.a); }

// The picture's rows come from the top.
vec3 skin_at(vec2 p) { return texture(skin, vec2(0.5 + p.x, 0.5 - p.y)).rgb; }

vec3 skinned(vec3 p, vec3 n) {
    vec3 side = vec3(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0, n.z < 0.0 ? -1.0 : 1.0);
    vec3 share = n * n * n * n;
    share /= share.x + share.y + share.z;
    return share.x * skin_at(vec2(-side.x * p.z, p.y)) + share.y * skin_at(vec2(p.x, -side.y * p.z)) +
           share.z * skin_at(vec2(side.z * p.x, p.y));
}

void main() {
    vec3 albedo = skin_repeats > 0.0 ? skinned(skin_repeats * in_body, normalize(normal_in_body)) : painted();
    pixel = vec4(lit(place, normalize(normal), albedo, gloss), 1);
}
)";

inline constexpr const char* surface_vertex_glsl = R"(
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec3 vertex_tint;
layout(location = 3) in vec2 vertex_cell;
uniform mat4 clip;
out vec3 place;
out vec3 normal;
out vec3 tint;
out vec2 cell;

void main() {
    place = vertex;
    normal = vertex_normal;
    tint = vertex_tint;
    cell = vertex_cell;
    gl_Position = clip * vec4(place, 1);
}
)";

// The texture of walls and floors, averaged over the pixel in closed form (Quilez, Filterable Procedurals, 2010): it
// turns to its mean in the distance and does not flicker.
inline constexpr const char* surface_fragment_glsl = R"(
in vec3 place;
in vec3 normal;
in vec3 tint;
in vec2 cell;
uniform int pattern;  // 0 plain, 1 checker, 2 grid
uniform float fade;   // distance at which a surface has gone over into the background
uniform vec3 background;
out vec4 pixel;

float checker(vec2 p, vec2 width) {
    vec2 square = (abs(fract((p - 0.5 * width) / 2.0) - 0.5) - abs(fract((p + 0.5 * width) / 2.0) - 0.5)) * 2.0 / width;
    return 0.5 - 0.5 * square.x * square.y;
}

float grid(vec2 p, vec2 width) {
    const float lines = 24.0;  // a line is a 24th of a cell
    vec2 high = p + 0.5 * width, low = p - 0.5 * width;
    vec2 line = (floor(high) + min(fract(high) * lines, 1.0) - floor(low) - min(fract(low) * lines, 1.0)) /
                (lines * width);
    return (1.0 - line.x) * (1.0 - line.y);
}

void main() {
    vec2 width = max(fwidth(cell), vec2(1e-6));
    float light = pattern == 1 ? mix(0.72, 1.0, checker(cell, width))
                : pattern == 2 ? mix(0.35, 1.0, grid(cell, width)) : 1.0;
    vec3 colour = lit(place, normal, tint * light, 0.0);
    pixel = vec4(mix(colour, background, smoothstep(0.4, 1.0, length(place) / fade)), 1);
}
)";

// Two triangles a billboard, spanned by two vectors; the sheet has 8 by 4 pictures, row by row from the top. It is
// pulled towards the eye by half its side, along the lines of sight: it covers the same pixels, and the floor does not
// cut it.
inline constexpr const char* billboard_vertex_glsl = R"(
layout(location = 0) in vec3 center;
layout(location = 1) in vec3 across;
layout(location = 2) in vec3 upward;
layout(location = 3) in float number;
uniform mat4 clip;
out vec2 in_sheet;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 tile = vec2(mod(number, 8.0), floor(number / 8.0));
    in_sheet = (tile + vec2(corner.x, 1.0 - corner.y)) / vec2(8.0, 4.0);
    vec2 side = 2.0 * corner - 1.0;
    float pull = max(1.0 - length(upward) / length(center), 0.3);
    gl_Position = clip * vec4(pull * (center + side.x * across + side.y * upward), 1);
}
)";

inline constexpr const char* billboard_fragment_glsl = R"(
in vec2 in_sheet;
uniform sampler2D sheet;
out vec4 pixel;

void main() { pixel = texture(sheet, in_sheet); }
)";

// A quad along the line, `thickness` pixels wide. It is cut off at the near plane, and pulled a little towards the eye,
// so that a line on a surface is seen.
inline constexpr const char* line_vertex_glsl = R"(
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 end;
layout(location = 2) in vec4 paint;
uniform mat4 clip;
uniform vec2 picture;  // its size in pixels
uniform float thickness;
out vec4 colour;

void main() {
    vec4 a = clip * vec4(start, 1), b = clip * vec4(end, 1);
    float before_a = a.z + a.w, before_b = b.z + b.w;
    if (before_a < 0.0 && before_b > 0.0) a = mix(a, b, before_a / (before_a - before_b));
    if (before_b < 0.0 && before_a > 0.0) b = mix(b, a, before_b / (before_b - before_a));
    vec2 along = (b.xy / b.w - a.xy / a.w) * picture;
    vec2 across = dot(along, along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(1, 0);
    vec4 place = (gl_VertexID & 1) == 0 ? a : b;
    place.xy += (gl_VertexID < 2 ? -1.0 : 1.0) * thickness * across / picture * place.w;
    place.z -= 1e-4 * place.w;
    colour = paint;
    gl_Position = before_a < 0.0 && before_b < 0.0 ? vec4(2, 2, 2, 1) : place;
}
)";

inline constexpr const char* line_fragment_glsl = R"(
in vec4 colour;
uniform float strength;
out vec4 pixel;

void main() { pixel = vec4(pow(colour.rgb, vec3(2.2)), strength * colour.a); }
)";

}  // namespace kolize::gl
