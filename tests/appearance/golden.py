#!/usr/bin/env python3
"""Values of every reflectance model, computed apart from the program.

Textbook forms in 50 digits: the distribution from the tangent of the half angle, masking from
Smith's Lambda, refraction from Snell's law. Only the fitted albedo of an interface shares its
numbers with the shaders, since the fit is part of the model.

    python3 golden.py > golden.csv
"""
import random

from mpmath import mp, mpf, sqrt, pi, acos, asin, atan2, tan, cos, sin

mp.dps = 50


def poly2(table, t, a):
    """sum of table[i][j] t^i a^j"""
    return sum(mpf(c) * t**i * a**j for i, row in enumerate(table) for j, c in enumerate(row))


LOSS_OVER = [["-0.00336", "0.09317", "1.7552", "-0.54912"], ["1.65289", "-0.81055", "-0.96872"],
             ["-3.43295", "0.70715"], ["1.78348"]]
LOSS_UNDER = [["0.57679", "-0.80506", "0.80967", "-0.28165"], ["2.87614", "-0.62389", "0.21578"],
              ["-6.24262", "0.49333"], ["3.7214"]]
COSINE_OVER = [["1.23986", "7.23334", "-3.24966"], ["-1.41008", "-12.0"], ["0.16083"]]
COSINE_UNDER = [["0.31469", "8.29508", "3.67251"], ["-0.15546", "-8.71006"], ["0.29286"]]
WHITE_MEAN = [["0.999962", "0.003956", "-2.884075", "5.08867", "-4.10955", "1.312381"]]
GRAZING_MEAN = [["0.047628", "-0.083194", "-0.28277", "1.07906", "-1.220033", "0.464282"]]


def albedo_split(mu, alpha):
    t = mu / (mu + alpha)
    white = 1 - max(mpf(0), t * poly2(LOSS_OVER, t, alpha) / poly2(LOSS_UNDER, t, alpha))
    c = mu + alpha * poly2(COSINE_OVER, t, alpha) / poly2(COSINE_UNDER, t, alpha)
    return white, white * (1 - min(max(c, mpf(0)), mpf(1)))**5


def mean_split(alpha):
    return poly2(WHITE_MEAN, mpf(0), alpha), poly2(GRAZING_MEAN, mpf(0), alpha)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def microfacets(wi, wo, ax, ay):
    """D G2 / (4 cos cos) and Schlick's weight"""
    h = [a + b for a, b in zip(wi, wo)]
    length = sqrt(dot(h, h))
    h = [x / length for x in h]
    theta, phi = acos(h[2]), atan2(h[1], h[0])
    e = tan(theta)**2 * ((cos(phi) / ax)**2 + (sin(phi) / ay)**2)
    d = 1 / (pi * ax * ay * cos(theta)**4 * (1 + e)**2)

    def smith(w):
        theta_w, phi_w = acos(w[2] / sqrt(dot(w, w))), atan2(w[1], w[0])
        a2 = (cos(phi_w) * ax)**2 + (sin(phi_w) * ay)**2
        return (-1 + sqrt(1 + a2 * tan(theta_w)**2)) / 2

    g = 1 / (1 + smith(wi) + smith(wo))
    return d * g / (4 * wi[2] * wo[2]), (1 - dot(wo, h))**5


def grazing(f0):
    return min(mpf(1), 50 * f0)


def interface(f0, f90, split):
    white, edge = split
    return f0 * (white - edge) + f90 * edge


def angles(w):
    return acos(w[2] / sqrt(dot(w, w))), atan2(w[1], w[0])


def eon(p, wi, wo):
    """Portsmouth, Kutz and Hill, EON (2025): angles, and the albedo by its arccosine form"""
    r = p["diffuse_roughness"]
    (ti, fi), (to, fo) = angles(wi), angles(wo)
    s = sin(ti) * sin(to) * cos(fi - fo)
    over = s / max(cos(ti), cos(to)) if s > 0 else s
    a = 1 / (1 + (mpf(1) / 2 - 2 / (3 * pi)) * r)

    def albedo(theta):
        g = sin(theta) * (theta - sin(theta) * cos(theta))
        g += mpf(2) / 3 * (tan(theta) * (1 - sin(theta)**3) - sin(theta))
        return a + r * a / pi * g
    mean = a * (1 + (mpf(2) / 3 - 28 / (15 * pi)) * r)
    values = []
    for rho in p["diffuse"]:
        many = rho**2 * mean / (1 - rho * (1 - mean)) / pi
        many *= (1 - albedo(ti)) * (1 - albedo(to)) / (1 - mean)
        values.append(rho / pi * a * (1 + r * over) + many)
    return values


def lambert(p, wi, wo):
    return [d / pi for d in p["diffuse"]]


def ggx_parts(p, wi, wo):
    f90 = grazing(max(p["f0"]))
    dgv, s = microfacets(wi, wo, p["ax"], p["ay"])
    low = min(p["ax"], p["ay"])**mpf("1.5") / sqrt(max(p["ax"], p["ay"]))
    specular = [(f + (f90 - f) * s) * dgv for f in p["f0"]]
    through = []
    for f in p["f0"]:
        e_i, e_o = (min(mpf(1), interface(f, f90, albedo_split(w[2], low))) for w in (wi, wo))
        through.append((1 - e_i) * (1 - e_o))
    mean = [min(mpf("0.999"), interface(f, f90, mean_split(low))) for f in p["f0"]]
    return specular, through, mean


def ggx(p, wi, wo):
    specular, through, mean = ggx_parts(p, wi, wo)
    return [s + d * t / (1 - m) / pi
            for s, d, t, m in zip(specular, p["diffuse"], through, mean)]


def clearcoat(p, wi, wo):
    specular, through, mean = ggx_parts(p, wi, wo)
    f0, alpha = p["coat_f0"], p["coat_alpha"]
    f90 = grazing(f0)
    dgv, s = microfacets(wi, wo, alpha, alpha)
    coat = (f0 + (f90 - f0) * s) * dgv
    index = (1 + sqrt(f0)) / (1 - sqrt(f0))
    path, passed = mpf(0), mpf(1)
    for w in (wi, wo):
        path += 1 / cos(asin(sin(acos(w[2])) / index))
        passed *= max(mpf(0), 1 - interface(f0, f90, albedo_split(w[2], alpha)))
    mean_passed = 1 - interface(f0, f90, mean_split(alpha))
    inside = 1 - mean_passed / index**2
    values = []
    for c in range(3):
        d = p["diffuse"][c]
        layer = d * (1 - inside) / (1 - d * inside) / min(1 - mean[c], mean_passed)
        base = specular[c] + layer * through[c] / pi
        values.append(coat + passed * p["coat_transmittance"][c]**path * base)
    return values


def direction(rng):
    z = rng.uniform(0.02, 1.0)
    phi = rng.uniform(0, 6.28318)
    s = sqrt(1 - mpf(z)**2)
    return [float(s * cos(mpf(phi))), float(s * sin(mpf(phi))), z]


MODELS = {"lambert": lambert, "eon": eon, "ggx": ggx, "clearcoat": clearcoat}


def columns(p):
    """names and numbers of a parameter set"""
    for name, value in p.items():
        ends = {1: [""], 2: ["_x", "_y"], 3: ["_r", "_g", "_b"]}[len(value)]
        yield from zip([name + end for end in ends], value)


def main():
    rng = random.Random(20)
    header = None
    for name, model in MODELS.items():
        for _ in range(50):
            alphas = [10**rng.uniform(-2, 0) for _ in range(3)]
            p = {"diffuse": [rng.random() for _ in range(3)],
                 "diffuse_roughness": [rng.random()],
                 "f0": [rng.random()**3 for _ in range(3)],
                 "specular": [rng.random()**2 for _ in range(3)],
                 "alpha": alphas[:2],
                 "exponent": [2 / a**2 - 2 for a in alphas[:2]],
                 "coat_alpha": alphas[2:],
                 "coat_f0": [rng.uniform(0.02, 0.1)],
                 "coat_transmittance": [rng.uniform(0.2, 1) for _ in range(3)]}
            wo = direction(rng)
            wi = direction(rng)
            if rng.random() < 0.6:  # near the mirror direction
                near = [-wo[0] + alphas[0] * rng.gauss(0, 1), -wo[1] + alphas[1] * rng.gauss(0, 1)]
                if near[0]**2 + near[1]**2 < 0.999:
                    wi = near + [float(sqrt(1 - mpf(near[0])**2 - mpf(near[1])**2))]
            exact = {key: [mpf(x) for x in v] for key, v in p.items()}
            exact = {key: v[0] if len(v) == 1 else v for key, v in exact.items()}
            exact["ax"], exact["ay"] = exact["alpha"]
            value = model(exact, [mpf(x) for x in wi], [mpf(x) for x in wo])
            pairs = list(columns(p))
            if header is None:
                header = ["model"] + [key for key, _ in pairs]
                header += [f"w{d}_{c}" for d in "io" for c in "xyz"] + list("rgb")
                print(",".join(header))
            numbers = [x for _, x in pairs] + wi + wo
            print(",".join([name] + [repr(x) for x in numbers] + [mp.nstr(v, 17) for v in value]))


if __name__ == "__main__":
    main()
