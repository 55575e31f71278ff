// color.glsl: transfer functions between stored and linear colour, and the tone curve. Pure functions.
//
// SHADERed converts nothing, neither when it reads a texture nor when it shows a picture: base colour has to be decoded and
// the result encoded here.
#ifndef COLOR_GLSL
#define COLOR_GLSL

// SRGB_DECODE, how a stored colour becomes linear. Largest absolute error against the standard's curve:
#define SRGB_POWER 0     // c^2.2, the exercise's: 0.0085
#define SRGB_PIECEWISE 1 // the curve of IEC 61966-2-1: 0
#define SRGB_CUBIC 2     // a polynomial without pow: 0.0017
#define SRGB_SQUARE 3    // c^2: 0.0425
#ifndef SRGB_DECODE
#define SRGB_DECODE SRGB_POWER
#endif

// TONE_CURVE, how radiance is brought into what a screen shows.
#define TONE_CLAMP 0    // cut off at 1
#define TONE_REINHARD 1 // Reinhard et al. 2002, eq. 4, per channel
#ifndef TONE_CURVE
#define TONE_CURVE TONE_CLAMP
#endif
#ifndef TONE_WHITE
#define TONE_WHITE 4.0 // the radiance that Reinhard's curve shows as white
#endif

// Stored sRGB colour, 0...1, to linear, 0...1.
vec3 srgb_to_linear(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
#if SRGB_DECODE == SRGB_PIECEWISE
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
#elif SRGB_DECODE == SRGB_CUBIC
    return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
#elif SRGB_DECODE == SRGB_SQUARE
    return c * c;
#else
    return pow(c, vec3(2.2));
#endif
}

// Linear colour, clamped to 0...1, to sRGB, by the curve of IEC 61966-2-1.
vec3 linear_to_srgb(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, lessThanEqual(c, vec3(0.0031308)));
}

// Linear radiance, 0 and more, to linear display colour, 0...1.
vec3 tone_map(vec3 radiance)
{
#if TONE_CURVE == TONE_REINHARD
    // c (1 + c/W^2) / (1 + c), arranged so that a huge c does not overflow: it is cut off where it reaches 1, at W.
    vec3 c = clamp(radiance, 0.0, TONE_WHITE);
    return c * (1.0 + c / (TONE_WHITE * TONE_WHITE)) / (1.0 + c);
#else
    return clamp(radiance, 0.0, 1.0);
#endif
}

#endif
