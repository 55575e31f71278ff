// Noise on the plane: by values and by slopes at the points of a grid.
#include "common/math.glsl"

#ifndef OCTAVES
#define OCTAVES 4
#endif

// A bijection of the 32-bit numbers that mixes their bits: multiplications by odd numbers, and shifts.
uint scramble(uint x) {
    x ^= x >> 16;
    x *= 0x9E3779B1u;
    x ^= x >> 15;
    x *= 0x85EBCA6Bu;
    return x ^ (x >> 16);
}

// A number in [0, 1) for each point of the grid, of 24 bits: float holds no more.
float grid_value(ivec2 cell) {
    uint mixed = scramble(uint(cell.x) + scramble(uint(cell.y)));
    return float(mixed >> 8) / 16777216.0;
}

// Flat at 0 and 1, its first two derivatives too.
vec2 fade(vec2 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// In [0, 1).
float value_noise(vec2 p) {
    ivec2 cell = ivec2(floor(p));
    vec2 t = fade(p - floor(p));
    float below = mix(grid_value(cell), grid_value(cell + ivec2(1, 0)), t.x);
    float above = mix(grid_value(cell + ivec2(0, 1)), grid_value(cell + ivec2(1, 1)), t.x);
    return mix(below, above, t.y);
}

float slope(ivec2 cell, vec2 away) {
    float angle = 6.2831853 * grid_value(cell);
    return dot(vec2(cos(angle), sin(angle)), away);
}

// 0 at the points of the grid, within +-1 between them.
float gradient_noise(vec2 p) {
    ivec2 cell = ivec2(floor(p));
    vec2 r = p - floor(p);
    vec2 t = fade(r);
    float below = mix(slope(cell, r), slope(cell + ivec2(1, 0), r - vec2(1.0, 0.0)), t.x);
    float above = mix(slope(cell + ivec2(0, 1), r - vec2(0.0, 1.0)), slope(cell + ivec2(1), r - vec2(1.0)), t.x);
    return mix(below, above, t.y);
}

// OCTAVES of value noise, each of twice the frequency and half the weight of the one before. In [0, 1).
float layered_noise(vec2 p) {
    float sum = 0.0, weight = 0.5;
    for (int k = 0; k < OCTAVES; ++k) {
        sum += weight * value_noise(p);
        p *= 2.0;
        weight *= 0.5;
    }
    return sum;
}
