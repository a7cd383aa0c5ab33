#include "filters/analysis/form.h"

#include "base/decompositions.h"
#include "base/error.h"
#include "base/reduce.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace multires {
namespace {

constexpr int most = 5;  ///< unknowns of a form
using Unknowns = Eigen::Matrix<double, most, 1>;

/// Points in a box of about one unit around the origin, for the sake of the equations' condition.
struct Cloud {
    Positions point;
    std::vector<double> weight;
};

/// Two directions that make a frame with `axis`.
std::pair<Vec3, Vec3> across(const Vec3& axis) {
    const Vec3 u = axis.unitOrthogonal();
    return {u, axis.cross(u)};
}

struct Equations {
    Eigen::Matrix<double, most, most> a = Eigen::Matrix<double, most, most>::Zero();
    Unknowns b = Unknowns::Zero();
    double squares = 0;
    Equations& operator+=(const Equations& o) {
        a += o.a, b += o.b, squares += o.squares;
        return *this;
    }
};

/// Distance of a point from the surface of a form with a radius, and how it changes with the unknowns: the centre or
/// the point and the tilt of the axis (along and across()), then the radius.
double distance_from(const Form& f, const Vec3& p, const std::pair<Vec3, Vec3>& frame, Unknowns& slope) {
    Vec3 v = p - f.point;
    const double along = f.kind == FormKind::cylinder ? v.dot(f.axis) : 0;
    if (f.kind == FormKind::cylinder) v -= along * f.axis;
    const double r = v.norm();
    const Vec3 u = r > 0 ? Vec3(v / r) : Vec3::Zero();
    slope.setZero();
    if (f.kind == FormKind::sphere) {
        slope.head<3>() = -u;
        slope[3] = -1;
    } else {
        const double a = u.dot(frame.first), b = u.dot(frame.second);
        slope << -a, -b, -along * a, -along * b, -1;
    }
    return r - f.radius;
}

Equations equations(const Form& f, const Cloud& cloud) {
    const auto frame = across(f.axis);
    return chunked_fold<Equations>(cloud.point.size(), [&](Equations& e, std::size_t i) {
        Unknowns slope;
        const double d = distance_from(f, cloud.point[i], frame, slope), w = cloud.weight[i];
        e.a += w * slope * slope.transpose();
        e.b += w * d * slope;
        e.squares += w * d * d;
    });
}

Form moved(Form f, const Unknowns& step) {
    if (f.kind == FormKind::sphere) {
        f.point += step.head<3>();
        f.radius += step[3];
        return f;
    }
    const auto [u, v] = across(f.axis);
    f.point += step[0] * u + step[1] * v;
    f.axis = (f.axis + step[2] * u + step[3] * v).normalized();
    f.radius += step[4];
    return f;
}

/// Steps until the squares no longer fall by a part of 1e-14.
double improve(Form& form, const Cloud& cloud) {
    const int unknowns = form.kind == FormKind::sphere ? 4 : 5;
    double damping = 1e-6;
    Equations now = equations(form, cloud);
    for (int round = 0; round < 30 && now.squares > 0; ++round) {
        Eigen::MatrixXd a = now.a.topLeftCorner(unknowns, unknowns);
        a.diagonal() += damping * a.diagonal() + Eigen::VectorXd::Constant(unknowns, 1e-300);
        Unknowns step = Unknowns::Zero();
        step.head(unknowns) = -solve_symmetric(a, now.b.head(unknowns));
        if (!step.allFinite()) break;
        const Form next = moved(form, step);
        const Equations then = equations(next, cloud);
        if (then.squares < now.squares) {
            const bool done = now.squares - then.squares <= 1e-14 * now.squares;
            form = next, now = then;
            damping = std::max(1e-12, 0.1 * damping);
            if (done) break;
        } else {
            damping *= 10;
            if (damping > 1e6) break;
        }
    }
    return now.squares;
}

/// Kasa's algebraic fit of a circle (d = 2, across the axis) or sphere (d = 3).
void start(Form& f, const Cloud& cloud) {
    const int d = f.kind == FormKind::sphere ? 3 : 2;
    const auto [u, v] = across(f.axis);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(d + 1, d + 1);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(d + 1), row(d + 1);
    for (std::size_t i = 0; i < cloud.point.size(); ++i) {
        const Vec3& p = cloud.point[i];
        if (d == 3) row << p, 1;
        if (d == 2) row << p.dot(u), p.dot(v), 1;
        a += cloud.weight[i] * row * row.transpose();
        b += cloud.weight[i] * row.head(d).squaredNorm() * row;
    }
    const Eigen::VectorXd x = solve_symmetric(a, b);
    f.point = d == 3 ? Vec3(0.5 * x.head<3>()) : Vec3(0.5 * (x[0] * u + x[1] * v));
    f.radius = std::sqrt(std::max(0.0, x[d] + f.point.squaredNorm()));
}

/// Eigenvectors, by ascending eigenvalue, of the spread of the points, or of the faces' normals.
Eigen::Matrix3d spread(const Array<Vec3>& vectors, const std::vector<double>& weight) {
    Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < vectors.size(); ++i) s += weight[i] * vectors[i] * vectors[i].transpose();
    return principal_axes(s).vectors;
}

Array<Vec3> area_vectors(const Mesh& mesh) {
    Array<Vec3> all(mesh.faces.size());
    for (std::size_t f = 0; f < all.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        const Vec3& p = mesh.positions[a];
        all[f] = 0.5 * (mesh.positions[b] - p).cross(mesh.positions[c] - p);
    }
    return all;
}

Form best_cylinder(const Cloud& cloud, const Array<Vec3>& areas) {
    Cloud few;
    const std::size_t stride = std::max<std::size_t>(1, cloud.point.size() / 4000);
    for (std::size_t i = 0; i < cloud.point.size(); i += stride) {
        few.point.push_back(cloud.point[i]);
        few.weight.push_back(cloud.weight[i]);
    }
    std::vector<double> per_area(areas.size());
    for (std::size_t f = 0; f < areas.size(); ++f) per_area[f] = areas[f].norm() > 0 ? 1 / areas[f].norm() : 0;
    const Eigen::Matrix3d starts[] = {spread(areas, per_area), spread(few.point, few.weight)};
    Form best;
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Matrix3d& axes : starts)
        for (int k = 0; k < 3; ++k) {
            Form f;
            f.kind = FormKind::cylinder;
            f.axis = axes.col(k);
            start(f, few);
            const double squares = improve(f, few);
            if (squares < least) least = squares, best = f;
        }
    improve(best, cloud);
    return best;
}

const char* name_of(FormKind kind) {
    switch (kind) {
    case FormKind::none:
        return "a height map over the xy plane";
    case FormKind::plane:
        return "a plane";
    case FormKind::sphere:
        return "a sphere";
    case FormKind::cylinder:
        break;
    }
    return "a cylinder";
}

/// Turns the form's outside to that of the faces, and refuses one that they lean against.
void orient(Form& form, const Mesh& mesh, const Array<Vec3>& areas) {
    std::vector<double> along(areas.size(), 0), size(areas.size(), 0);
    double sum = 0, all = 0, leaning = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
        along[f] = areas[f].dot(foot(form, middle).normal);
        size[f] = areas[f].norm();
        sum += along[f], all += size[f];
    }
    if (sum < 0) form.outwards = -1;
    for (std::size_t f = 0; f < areas.size(); ++f)
        if (form.outwards * along[f] < 0.5 * size[f]) leaning += size[f];
    if (leaning > 0.1 * all)
        throw InputError(std::string("form: ") + name_of(form.kind) +
                         " does not fit: " + std::to_string(static_cast<int>(std::lround(100 * leaning / all))) +
                         " % of the surface leans against it by more than 60 degrees");
}

}  // namespace

FormFoot foot(const Form& form, const Vec3& p) {
    if (form.kind == FormKind::none || form.kind == FormKind::plane) {
        const double h = (p - form.point).dot(form.axis);
        return {p - h * form.axis, form.outwards * form.axis, form.outwards * h};
    }
    Vec3 v = p - form.point;
    if (form.kind == FormKind::cylinder) v -= v.dot(form.axis) * form.axis;
    const double r = v.norm();
    const Vec3 u = r > 0 ? Vec3(v / r) : form.axis.unitOrthogonal();
    return {p + (form.radius - r) * u, form.outwards * u, form.outwards * (r - form.radius)};
}

Form fit_form(FormKind kind, const Mesh& mesh, const std::vector<double>& weight) {
    const Box box = bounding_box(mesh.positions);
    const double size = box.diagonal();
    Form form;
    form.kind = kind;
    Cloud cloud;
    double total = 0;
    for (const double w : weight) total += w;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        if (!(weight[i] > 0)) continue;
        cloud.point.push_back((mesh.positions[i] - box.center()) / size);
        cloud.weight.push_back(weight[i] / total);
    }
    const Array<Vec3> areas = area_vectors(mesh);
    switch (kind) {
    case FormKind::none:
        break;
    case FormKind::plane: {
        for (std::size_t i = 0; i < cloud.point.size(); ++i) form.point += cloud.weight[i] * cloud.point[i];
        for (Vec3& p : cloud.point) p -= form.point;
        form.axis = spread(cloud.point, cloud.weight).col(0);
        break;
    }
    case FormKind::sphere:
        start(form, cloud);
        improve(form, cloud);
        break;
    case FormKind::cylinder:
        form = best_cylinder(cloud, areas);
        break;
    }
    if (kind != FormKind::none) form.point = box.center() + size * form.point;
    form.radius *= size;
    if (!(std::isfinite(form.radius) && form.radius < 1e4 * size && form.point.allFinite()))
        throw InputError(std::string("form: ") + name_of(kind) + " does not fit: the surface is flat");
    orient(form, mesh, areas);
    return form;
}

}  // namespace multires
