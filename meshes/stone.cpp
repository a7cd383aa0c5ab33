#include "base/angles.h"
#include "random.h"
#include "shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires::shapes {

namespace {

/// A straight stroke in a letter's box of 1 by 1.5.
struct Stroke {
    double x0, y0, x1, y1;
};

std::vector<Stroke> strokes_of(char letter) {
    switch (letter) {
    case 'A':
        return {{0, 0, 0.5, 1.5}, {0.5, 1.5, 1, 0}, {0.2, 0.6, 0.8, 0.6}};
    case 'E':
        return {{0, 0, 0, 1.5}, {0, 0, 0.8, 0}, {0, 0.75, 0.7, 0.75}, {0, 1.5, 0.8, 1.5}};
    case 'I':
        return {{0.5, 0, 0.5, 1.5}};
    case 'L':
        return {{0, 0, 0, 1.5}, {0, 0, 0.8, 0}};
    case 'M':
        return {{0, 0, 0.1, 1.5}, {0.1, 1.5, 0.5, 0.2}, {0.5, 0.2, 0.9, 1.5}, {0.9, 1.5, 1, 0}};
    case 'N':
        return {{0, 0, 0, 1.5}, {0, 1.5, 0.9, 0}, {0.9, 0, 0.9, 1.5}};
    case 'T':
        return {{0.5, 0, 0.5, 1.5}, {0, 1.5, 1, 1.5}};
    case 'V':
        return {{0, 1.5, 0.5, 0}, {0.5, 0, 1, 1.5}};
    default:
        return {};
    }
}

double distance(const Stroke& s, double x, double y) {
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
    const double t = std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(x - s.x0 - t * dx, y - s.y0 - t * dy);
}

/// The words in two lines, strokes in millimetres.
std::vector<Stroke> inscription(double width, double height) {
    const std::array<const char*, 2> lines{"ANIMVLA", "LAETITIA"};
    std::vector<Stroke> all;
    const double step = width / 9, size = 0.72 * step, line = 0.42 * height;
    for (int row = 0; row < 2; ++row) {
        double x = 0.5 * (9 - static_cast<double>(std::string(lines[row]).size())) * step + 0.14 * step;
        const double y = height - 0.14 * height - size * 1.5 - row * line;
        for (const char* c = lines[row]; *c != '\0'; ++c, x += step)
            for (const Stroke& s : strokes_of(*c))
                all.push_back({x + size * s.x0, y + size * s.y0, x + size * s.x1, y + size * s.y1});
    }
    return all;
}

}  // namespace

EngravedStone engraved_stone(const EngravedStoneOptions& o) {
    Random random(o.seed);
    EngravedStone out;
    const Index n = std::max<Index>(8, static_cast<Index>(std::lround(o.width / o.spacing)));
    Irregular irregular = o.irregular;
    irregular.seed = random.bits();
    out.mesh = plane(n, irregular);
    // The lower half of the square: a stone twice as wide as it is high.
    Mesh half;
    std::vector<Index> number(out.mesh.positions.size(), -1);
    for (Face f : out.mesh.faces) {
        if (std::any_of(f.begin(), f.end(), [&](Index v) { return out.mesh.positions[v].y() > 0.5; })) continue;
        for (Index& v : f) {
            if (number[v] < 0) {
                number[v] = static_cast<Index>(half.positions.size());
                half.positions.push_back(o.width * out.mesh.positions[v]);
            }
            v = number[v];
        }
        half.faces.push_back(f);
    }
    out.mesh = std::move(half);
    const double bend_x = 1 / random.uniform(120, 400), bend_y = 1 / random.uniform(60, 200);
    const double tilt = random.uniform(0, pi), period = random.uniform(2.5, 5);
    std::array<std::array<double, 4>, 12> wave;
    for (auto& w : wave) {
        const double angle = random.uniform(0, 2 * pi), k = 2 * pi / random.uniform(25, 80);
        w = {k * std::cos(angle), k * std::sin(angle), random.uniform(0, 2 * pi), random.uniform(0.05, 0.25)};
    }
    const std::vector<Stroke> strokes = inscription(o.width, 0.5 * o.width);
    for (Vec3& p : out.mesh.positions) {
        const double x = p.x(), y = p.y(), u = x - 0.5 * o.width, v = y - 0.25 * o.width;
        double height = -0.5 * (bend_x * u * u + bend_y * v * v), wander = 0;
        for (const auto& w : wave) {
            const double value = w[3] * std::cos(w[0] * x + w[1] * y + w[2]);
            height += value, wander += value;
        }
        // Furrows of the chisel wander with the surface and are now and then deeper.
        const double phase = 2 * pi * (std::cos(tilt) * x + std::sin(tilt) * y) / period + 4 * wander;
        height += o.chisel * std::cos(phase) * (1 + 0.5 * std::cos(0.13 * phase));
        double nearest = o.stroke;
        for (const Stroke& s : strokes) nearest = std::min(nearest, distance(s, x, y));
        const double cut = o.depth * std::max(0.0, 1 - 2 * nearest / o.stroke);
        out.cut.push_back(cut);
        double noise = 0;  // nearly normal: the sum of twelve uniform numbers
        for (int i = 0; i < 12; ++i) noise += random.uniform(-0.5, 0.5);
        p.z() = height - cut + o.noise * noise;
    }
    return out;
}

}  // namespace multires::shapes
