// half.glsl: the highlight for half precision, on the rung D_HALF. brdf.glsl includes it in the place of its own highlight().
//
// A half has 11 binary digits, is 65504 at most, and below 6.1e-5 loses digits or is 0. So the guards of the other rungs
// are 0 or infinite, |H|^2 has no digits left where l and v are nearly opposite, and alpha^4, or k^2, leaves the range.
// Here 16 H takes the place of H, which cancels in k and which a GPU gets for nothing; k^2 never stands by itself; and the
// highlight ends at HALF_MOST.
#ifndef HALF_GLSL
#define HALF_GLSL

// S = D V n.l, and the cosines, as the highlight() of the other rungs.
float highlight(vec3 l, vec3 v, vec3 n, float alpha, out Cosines g)
{
    float NoL = clamp(dot(n, l), 0.0, 1.0);
    float NoV = clamp(dot(n, v), 0.0, 1.0);
    float behind = clamp(1.0 - HALF_MOST * NoV, 0.0, 1.0); // also where NoV is below 1.7e-5, which a half hardly tells from 0
    float lit = clamp(NoL / (2.0 * PI) - behind, 0.0, 1.0);

    vec3 H8 = 4.0 * (l + v); // 8 H, and so on
    float NoHH8 = 4.0 * (NoL + NoV);
    vec3 p16 = 2.0 * (H8 - n * NoHH8);
    float sin2 = dot(p16, p16);
    float HH = sin2 + 4.0 * (NoHH8 * NoHH8); // 256 |H|^2
    float k = alpha * HH / half_divisor(sin2, 2.0 * (alpha * NoHH8));
    float c = sqrt(HH) / 16.0;
    g = Cosines(NoL, NoV, c, c * c, lit);

#if BRDF_V == V_EXACT
    float alpha2 = alpha * alpha;
    float masking = sqrt((NoV - alpha2 * NoV) * NoV + alpha2);
    float shadowing = sqrt((NoL - alpha2 * NoL) * NoL + alpha2);
    float V = 1.0 / (NoL * (2.0 * masking) + (NoV * (2.0 * shadowing) + HALF_LEAST));
#else
    float V = visibility(NoL, NoV, c, alpha);
#endif
    return min(2.0 * (k * (k * (V * lit))), HALF_MOST);
}

#endif
