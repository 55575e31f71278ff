// brdf.glsl: how a surface reflects light: Lambert under a GGX microfacet layer. Pure functions, no uniforms.
//
// Notation of the field: l points to the light, v to the viewer, n is the normal, h = (l + v)/|l + v| the half vector,
// all unit; NoL is n.l clamped to 0...1, and so on; alpha = roughness^2. Colours are linear.
//
// Each term with a real trade has rungs, chosen by a macro of the pass: ladder.glsl lists them.
#ifndef BRDF_GLSL
#define BRDF_GLSL

#include "ladder.glsl"

const float PI = 3.14159265358979;
const float DIELECTRIC_F0 = 0.04; // reflectance at normal incidence of a refractive index of 1.5
const float TINY = 1.2e-38;       // just above the smallest normal float: a divisor that is never reached otherwise

// What half precision has to say of numbers: 65504 is its largest, 6.1e-5 its smallest that keeps its digits, and below
// that a GPU may take 0. In float32 these guards are for the rung D_HALF alone.
const float HALF_LEAST = 6.2e-5; // added to a divisor, or the least of it
const float HALF_MOST = 6e4;     // of a highlight: what it is part of stays below 65504, whatever the roundings

struct Material {
    vec3 albedo;     // 0...1: colour scattered by a dielectric, F0 of a metal
    float metalness; // 0...1
    float roughness; // 0...1
};

// ---- The exercise's three terms --------------------------------------------------------------------------------------

// Trowbridge-Reitz/GGX distribution of normals [Walter et al. 2007, eq. 33; Trowbridge & Reitz 1975].
// NoH and alpha in 0...1; per steradian, up to 1/(pi alpha^2).
// In exact arithmetic 1 + NoH^2 (alpha^2 - 1) is never below alpha^2: the max() only mends what rounding does to it.
float D_GGX(float NoH, float alpha)
{
    float alpha2 = alpha * alpha;
    float k = alpha / max(1.0 + NoH * NoH * (alpha2 - 1.0), max(alpha2, TINY));
    return k * k / PI;
}

// Smith's height-correlated masking and shadowing for GGX, G / (4 NoL NoV) [Heitz 2014, eq. 99].
// Finite also where the formula is 1/0 (both cosines 0, or alpha and one of them).
float V_SmithGGXCorrelated(float NoL, float NoV, float alpha)
{
    float alpha2 = alpha * alpha;
    float masking = NoL * sqrt(alpha2 + NoV * (NoV - alpha2 * NoV));
    float shadowing = NoV * sqrt(alpha2 + NoL * (NoL - alpha2 * NoL));
    return 0.5 / max(masking + shadowing, TINY);
}

// (1 - LoH)^5, the weight of white in Schlick's Fresnel term.
float schlick_weight(float LoH)
{
    float x = clamp(1.0 - LoH, 0.0, 1.0);
#if BRDF_F == F_POW
    return pow(x, 5.0);
#elif BRDF_F == F_GAUSSIAN
    float c = 1.0 - x; // a spherical Gaussian in place of the power [Lagarde 2012; Karis 2013, eq. 5]
    return exp2((-5.55473 * c - 6.98316) * c);
#else
    float x2 = x * x;
    return x2 * x2 * x;
#endif
}

// Fresnel reflectance, approximated [Schlick 1994, eq. 15]. F0 is the reflectance at normal incidence, 0...1.
vec3 F_Schlick(vec3 F0, float LoH)
{
    return F0 + (1.0 - F0) * schlick_weight(LoH);
}

// The model as the exercise writes it, term by term. Right in the middle of the range. Below roughness 0.1 the rounding of
// NoH alone is larger than what the highlight is made of, and at l = -v there is no half vector and it is NaN; use shade().
vec3 shade_exercise(vec3 l, vec3 v, vec3 n, Material m)
{
    float alpha = m.roughness * m.roughness;
    vec3 h = normalize(l + v);
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    float NoH = clamp(dot(n, h), 0.0, 1.0);
    float LoH = clamp(dot(l, h), 0.0, 1.0);

    vec3 F = F_Schlick(mix(vec3(DIELECTRIC_F0), m.albedo, m.metalness), LoH);
    vec3 specular = F * D_GGX(NoH, alpha) * V_SmithGGXCorrelated(NoL, NoV, alpha);
    vec3 diffuse = (1.0 - F) * (1.0 - m.metalness) * m.albedo / PI;
    return (diffuse + specular) * NoL;
}

#include "rungs.glsl" // the terms in other forms: visibility(), lambert_share() and others below

// ---- The same model, for every input ---------------------------------------------------------------------------------

// shade() below says what these are and how they are arrived at.
struct Cosines {
    float NoL; // 0...1, and so on
    float NoV;
    float c; // l.h
    float c2;
    float lit; // n.l/2pi, which is below 1; 0 for a viewer behind the surface
};

#if BRDF_D == D_HALF
#include "half.glsl" // highlight() for half precision
#else
// S = D V n.l, steps 1 to 3 of shade().
float highlight(vec3 l, vec3 v, vec3 n, float alpha, out Cosines g)
{
    float alpha2 = alpha * alpha + 1e-26; // so that k <= 5e12 and S < 1e38: nothing here leaves float's range
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    float behind = clamp(1.0 - 1e38 * NoV, 0.0, 1.0); // 1 where NoV is 0, the viewer behind the surface; else 0
    float lit = clamp(NoL / (2.0 * PI) - behind, 0.0, 1.0);

    vec3 H = 0.5 * (l + v);
    float NoHH = 0.5 * (NoL + NoV); // n.H where it matters: with both cosines positive
#if BRDF_D == D_PROJECT || BRDF_D == D_CROSS
#if BRDF_D == D_CROSS
    vec3 p = cross(n, H);
#else
    vec3 p = H - n * NoHH;
#endif
    // |H|^2 times the squared sine and cosine of the angle between n and h. Where H is 0, 1e-37 makes 0/0 a number.
    float sin2 = p.x * p.x + (p.y * p.y + (p.z * p.z + 1e-37));
    float cos2 = NoHH * NoHH;
    float HH = sin2 + cos2;
    float k = alpha * HH / (sin2 + alpha2 * cos2);
#else
    float HH = dot(H, H);
    float k = distribution_root(n, H, NoHH, alpha);
#endif
    g = Cosines(NoL, NoV, sqrt(HH), HH, lit);

#if BRDF_V == V_EXACT
    float masking = sqrt((NoV - alpha2 * NoV) * NoV + alpha2);
    float shadowing = sqrt((NoL - alpha2 * NoL) * NoL + alpha2);
    float V = 0.5 / (NoL * masking + (NoV * shadowing + 1e-37));
#else
    float V = visibility(NoL, NoV, g.c, alpha);
#endif
#if BRDF_V == V_KELEMEN
    return min(2.0 * (k * k * (V * lit)), 1e37); // at the horizons its V has no end that the peak of D could meet
#elif BRDF_V == V_HAMMON && BRDF_D != D_PROJECT && BRDF_D != D_CROSS
    return k * k * (V * (2.0 * lit)); // where n.h is rounded to 1 at the horizons, a driver's other order leaves float's range
#else
    return 2.0 * (k * k * (V * lit));
#endif
}
#endif

// Radiance reflected toward v per unit of irradiance perpendicular to l: (diffuse + specular) (n.l)+.
// Defined, finite and >= 0 for every unit l, v, n and every material in 0...1; 0 on the back side, at both horizons and
// where l = -v. Below roughness 1e-6 the highlight falls behind the model's, which leaves float's range at 2.5e-7; at 0, a
// mirror, there is none: a light without extent is not seen in it.
//
// It equals shade_exercise() in exact arithmetic, step by step, a for the albedo and m for the metalness:
//   1. With H = (l + v)/2, not normalised, n.H = (n.l + n.v)/2, and l.h = |H| = c, because l and v are unit. No division
//      by |H|.
//   2. p = H - n (n.H), the part of H across n, has |p|^2 + (n.H)^2 = |H|^2, because n is unit. For a small angle between n
//      and h it keeps the digits that 1 - (n.h)^2 has lost: the cosine of a small angle is all ones. The roundings of n's
//      length, of n.H and of p are as if n had been turned by less than 4e-7. D_CROSS takes n x H, which is as long, and
//      which no error of n's length can tilt: at h = n, below roughness 0.01, it is nearer.
//   3. So 1 + (n.h)^2 (alpha^2 - 1) = (|p|^2 + alpha^2 (n.H)^2) / |H|^2, and D = k^2/pi with
//      k = alpha |H|^2 / (|p|^2 + alpha^2 (n.H)^2).
//   4. With x = 1 - c and q = c - c^2/2, 1 - x^2 = 2q, and 1 - x^4 = (1 - x^2)(1 + x^2) = 4 (q - q^2) = y. With w = x^5,
//      w = x - x y, and W = 1 - w = c + x y: nothing cancels in W as c goes to 0, nor y's rounding grow in w.
//   5. F0 = 0.04 (1 - m) + m a, so F = F0 + (1 - F0) w = F0 W + w = A a + B with A = m W, B = w + 0.04 G, G = (1 - m) W.
//   6. 1 - F = (1 - B) - A a, and 1 - B = W - 0.04 G = Z.
//   7. With S = D V n.l and E = (1 - m) n.l/pi the sum S F + E (1 - F) a is (S A + E Z - E A a) a + S B. Z >= A, since
//      Z - A = 0.96 G: it is not negative. All but a is the same for the three colours.
// A GPU clamps to 0...1, halves, doubles and quadruples what it computes for nothing: constants are arranged for that.
// Other rungs put another k, V or w in their places, or scatter another share of the albedo; what adds up is the same.
vec3 shade(vec3 l, vec3 v, vec3 n, Material m)
{
    Cosines g;
    float S = highlight(l, v, n, m.roughness * m.roughness, g);

    float c = g.c;
#if BRDF_F == F_GAUSSIAN || BRDF_D == D_HALF // in half precision x - x y has lost w where it is small
    float w = schlick_weight(c);
    float W = 1.0 - w;
#else
    float x = 1.0 - c;
    float q = c - 0.5 * g.c2;    // (1 - x^2)/2
    float y = 4.0 * (q - q * q); // 1 - x^4
    float W = x * y + c;         // 1 - x^5
#if BRDF_F == F_POW
    float w = schlick_weight(c);
#else
    float w = x - x * y; // x^5
#endif
#endif
    float dielectric = 1.0 - m.metalness;
    float A = m.metalness * W;
#if BRDF_F == F_DIELECTRIC
    vec2 exact = fresnel_dielectric(c);
    float B = m.metalness * w + dielectric * exact.x;
    float Z = A + dielectric * exact.y;
#else
    float G = dielectric * W;
    float B = DIELECTRIC_F0 * G + w;
#if BRDF_D == D_HALF
    float Z = (1.0 - DIELECTRIC_F0) * G + A; // so that no rounding makes it less than A
#else
    float Z = -DIELECTRIC_F0 * G + W;
#endif
#endif
    float E = 2.0 * (dielectric * g.lit);

    // The same for each of the rungs: S F + E times what is scattered. Three colours take part only where they must.
#if BRDF_MULTI == MULTI_FITTED || BRDF_F == F_F82 || BRDF_DIFFUSE == DIFFUSE_EON
    vec3 F = A * m.albedo + B;
    vec3 left = Z - A * m.albedo; // 1 - F
#if BRDF_F == F_F82
    vec3 drop = m.metalness * f82_drop(m.albedo, c);
    F = max(F - drop, 0.0);
    left = left + drop;
#endif
#if BRDF_DIFFUSE == DIFFUSE_FRESNEL
    vec3 scattered = m.albedo * left;
#elif BRDF_DIFFUSE == DIFFUSE_EON
    vec3 scattered = diffuse_eon(m.albedo, m.roughness, g.NoL, g.NoV, dot(l, v));
#else
    vec3 scattered = m.albedo * lambert_share(g.NoL, g.NoV, c, m.roughness);
#endif
    vec3 F0 = dielectric * DIELECTRIC_F0 + m.metalness * m.albedo;
    return S * F * compensation(F0, g.NoV, m.roughness) + E * scattered;
#elif BRDF_DIFFUSE == DIFFUSE_FRESNEL
    return m.albedo * (S * A + E * Z - E * A * m.albedo) + S * B;
#else
    return m.albedo * (S * A + E * lambert_share(g.NoL, g.NoV, c, m.roughness)) + S * B;
#endif
}

#endif
