// Colours in other coordinates.
#include "common/math.glsl"

// Hue, saturation and value, each in [0, 1].
vec3 rgb_to_hsv(vec3 c) {
    float value = max3(c);
    float chroma = value - min3(c);
    if (chroma == 0.0)
        return vec3(0.0, 0.0, value);
    float sector = value == c.r ? (c.g - c.b) / chroma
                 : value == c.g ? 2.0 + (c.b - c.r) / chroma
                                : 4.0 + (c.r - c.g) / chroma;
    return vec3(fract(sector / 6.0), chroma / value, value);
}

vec3 hsv_to_rgb(vec3 hsv) {
    vec3 ramp = saturate(abs(fract(hsv.x + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0);
    return hsv.z * mix(vec3(1.0), ramp, hsv.y);
}

vec3 cube_root(vec3 v) {
    return sign(v) * pow(abs(v), vec3(1.0 / 3.0));
}

// Linear sRGB to OKLab, with the matrices of its author, B. Ottosson, 2020.
vec3 to_oklab(vec3 c) {
    const mat3 cones = mat3(0.4122214708, 0.2119034982, 0.0883024619,
                            0.5363325363, 0.6806995451, 0.2817188376,
                            0.0514459929, 0.1073969566, 0.6299787005);
    const mat3 lab = mat3(0.2104542553, 1.9779984951, 0.0259040371,
                          0.7936177850, -2.4285922050, 0.7827717662,
                          -0.0040720468, 0.4505937099, -0.8086757660);
    return lab * cube_root(cones * c);
}

vec3 from_oklab(vec3 lab) {
    const mat3 cones = mat3(1.0, 1.0, 1.0,
                            0.3963377774, -0.1055613458, -0.0894841775,
                            0.2158037573, -0.0638541728, -1.2914855480);
    const mat3 rgb = mat3(4.0767416621, -1.2684380046, -0.0041960863,
                          -3.3077115913, 2.6097574011, -0.7034186147,
                          0.2309699292, -0.3413193965, 1.7076147010);
    vec3 roots = cones * lab;
    return rgb * (roots * roots * roots);
}

// Luma and two differences, without loss: whole numbers in, whole numbers out.
ivec3 to_ycocg(ivec3 c) {
    int co = c.r - c.b;
    int between = c.b + (co >> 1);
    int cg = c.g - between;
    return ivec3(between + (cg >> 1), co, cg);
}

ivec3 from_ycocg(ivec3 y) {
    int between = y.x - (y.z >> 1);
    int blue = between - (y.y >> 1);
    return ivec3(blue + y.y, y.z + between, blue);
}
