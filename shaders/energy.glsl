// energy.glsl: how much a GGX surface reflects in all, fitted. Pure functions.
//
// Fits of our own to quadrature of height-correlated GGX, by least squares, reweighted for the largest error; fit_energy.py
// makes the coefficients. s = NoV/(NoV + alpha): where a surface is smooth, the albedo depends on NoV/alpha alone.
#ifndef ENERGY_GLSL
#define ENERGY_GLSL

// NoV/(NoV + alpha), and 0 where both are.
float energy_s(float NoV, float alpha)
{
    return NoV / (NoV + alpha + 1e-37);
}

// (1 - E)/E, E(NoV, roughness) being the directional albedo of GGX with F = 1: what is lost between microfacets, as a share
// of what is not. 0 and more, up to 2.3. E (1 + this), a white metal in a white furnace, is within 0.013 of 1.
float energy_lost(float NoV, float roughness)
{
    float a = roughness * roughness;
    float s = energy_s(NoV, a);
    float p0 = ((-1.6653 * a + 6.5766) * a - 0.6919) * a - 0.0573;
    float p1 = ((10.5495 * a - 26.358) * a + 6.9193) * a + 2.0016;
    float p2 = ((25.2172 * a + 14.841) * a - 5.417) * a - 2.017;
    return max(s * (1.0 - s) * ((p2 * s + p1) * s + p0), 0.0);
}

// The cosine c at which Schlick's weight (1 - c)^5 is the mean of all (1 - l.h)^5 that GGX reflects toward NoV, 0...1.
// With it E (0.04 + 0.96 (1 - c)^5), the albedo of a dielectric, is within 0.007, and with its exact F(c) within 0.019.
float energy_cosine(float NoV, float roughness)
{
    float r = roughness;
    float s = energy_s(NoV, r * r);
    float p0 = ((1.5715 * r - 3.3692) * r + 2.1103) * r + 0.1594;
    float p1 = (0.0733 * r - 0.4878) * r - 0.1647;
    float p2 = -1.1143 * r + 0.0625;
    return max(NoV + r * (((-0.1187 * s + p2) * s + p1) * s + p0), 0.0);
}

#endif
