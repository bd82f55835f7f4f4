// A tool grown by a distance that varies over it: a cubic B-spline over one, two or three directions of the tool.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "umform/surfaces/concept.hpp"

namespace umform {

/// A function of position with its first and second derivatives.
struct FieldValue {
    double w;
    Vec3 slope;
    Mat3 curvature;
};

/// w(x) = sum over i, j, k of c_ijk b(s_1 - i) b(s_2 - j) b(s_3 - k), where s = (e . x - low)/spacing along each direction e and b is
/// the uniform cubic B-spline. Beyond the first and the last coefficient that one is repeated: w is constant there, and twice
/// continuously differentiable everywhere. eqs. (4.262), (4.263)
class SplineField {
  public:
    /// A direction, a unit vector; the place of its first coefficient along it, the distance of two, and how many there are.
    struct Axis {
        Vec3 direction;
        double low, spacing;
        int count;
    };

    /// Coefficients, those of the last direction next to each other.
    SplineField(std::vector<Axis> axes, std::vector<double> coefficients)
        : axes_(std::move(axes)), c_(std::move(coefficients)) {
        for (const Axis& axis : axes_) spacing_ = std::min(spacing_, axis.spacing);
        for (const double c : c_) least_ = std::min(least_, c), most_ = std::max(most_, c);
    }

    double spacing() const { return spacing_; }
    /// Bounds of its values.
    double least() const { return least_; }
    double most() const { return most_; }

    FieldValue at(const Vec3& x) const {
        std::array<Weights, 3> along{{one, one, one}};
        for (std::size_t k = 0; k < axes_.size(); ++k) along[k] = weights(axes_[k], x);
        double w = 0.0, first[3]{}, second[3][3]{};
        for (int i = 0; i < along[0].size; ++i)
            for (int j = 0; j < along[1].size; ++j)
                for (int k = 0; k < along[2].size; ++k) {
                    const double c =
                        c_[(static_cast<std::size_t>(along[0].id[i]) * along[1].of + along[1].id[j]) * along[2].of
                           + along[2].id[k]];
                    const int at[3]{i, j, k};
                    for (int p = 0; p < 3; ++p) {
                        first[p] += c * product(along, at, p, -1);
                        for (int q = 0; q <= p; ++q) second[p][q] += c * product(along, at, p, q);
                    }
                    w += c * product(along, at, -1, -1);
                }
        FieldValue field{w, {}, {}};
        for (std::size_t p = 0; p < axes_.size(); ++p)
            for (int a = 0; a < 3; ++a) {
                field.slope[a] += first[p] * axes_[p].direction[a];
                for (std::size_t q = 0; q < axes_.size(); ++q)
                    for (int b = 0; b < 3; ++b)
                        field.curvature(a, b) +=
                            second[std::max(p, q)][std::min(p, q)] * axes_[p].direction[a] * axes_[q].direction[b];
            }
        return field;
    }

  private:
    /// The coefficients that count at a place along a direction: their numbers, and b, b', b'' of each.
    struct Weights {
        int size, of;
        std::array<int, 4> id;
        std::array<std::array<double, 4>, 3> b;
    };
    static constexpr Weights one{1, 1, {0}, {{{1.0}, {0.0}, {0.0}}}};

    static Weights weights(const Axis& axis, const Vec3& x) {
        if (axis.count == 1) return one;
        const double place = (dot(axis.direction, x) - axis.low) / axis.spacing;
        const double s = place > -2.0 ? std::min(place, axis.count + 1.0) : -2.0;  // not a number: -2
        const double whole = std::floor(s), t = s - whole, u = 1.0 - t, h = axis.spacing;
        Weights found{4, axis.count, {}, {}};
        for (int k = 0; k < 4; ++k) found.id[k] = std::clamp(static_cast<int>(whole) - 1 + k, 0, axis.count - 1);
        found.b[0] = {u * u * u / 6.0, ((3.0 * t - 6.0) * t * t + 4.0) / 6.0, ((3.0 * u - 6.0) * u * u + 4.0) / 6.0,
                      t * t * t / 6.0};
        found.b[1] = {-0.5 * u * u / h, (1.5 * t - 2.0) * t / h, -(1.5 * u - 2.0) * u / h, 0.5 * t * t / h};
        found.b[2] = {u / (h * h), (3.0 * t - 2.0) / (h * h), (3.0 * u - 2.0) / (h * h), t / (h * h)};
        return found;
    }

    /// Product of the three weights, differentiated along p and q unless they are -1.
    static double product(const std::array<Weights, 3>& along, const int* at, int p, int q) {
        double value = 1.0;
        for (int k = 0; k < 3; ++k) value *= along[k].b[(k == p) + (k == q)][at[k]];
        return value;
    }

    std::vector<Axis> axes_;
    std::vector<double> c_;
    double spacing_ = std::numeric_limits<double>::infinity();
    double least_ = std::numeric_limits<double>::infinity(), most_ = -std::numeric_limits<double>::infinity();
};

/// The tool whose surface is phi = w. Its gap is the distance to that surface: the foot of a point is found by Newton's method
/// from distance and Hessian of the tool beside its surface. eqs. (4.264) to (4.266)
class OffsetByField final : public Surface {
  public:
    OffsetByField(std::shared_ptr<const Surface> tool, SplineField field)
        : tool_(std::move(tool)), field_(std::move(field)) {}

    bool is_distance() const override { return tool_->is_distance(); }
    double above() const override { return tool_->above() + field_.most() - field_.least(); }
    bool is_concurrent() const override { return tool_->is_concurrent(); }
    bool searches() const override { return tool_->searches(); }

    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        gap_again(count, x, nullptr, g, n, H);
    }
    void gap_again(int count, const double* x, Nearby* nearby, double* g, double* n, double* H) const override {
        of_tool(count, x, nearby, g, n, H);
        std::vector<Foot> feet;
        for (int q = 0; q < count; ++q) {
            if (g[q] > field_.most() + field_.spacing())
                g[q] -= field_.most();
            else if (g[q] < field_.least() - field_.spacing())
                g[q] -= field_.least();
            else {
                const Vec3 here{x[3 * q], x[3 * q + 1], x[3 * q + 2]};
                const Level level = at(here, g[q], n + 3 * q, H + 9 * q);
                feet.push_back({q, here, here, level, level});
            }
        }
        find(feet, nearby);
        for (const Foot& foot : feet) write(foot, g + foot.of, n + 3 * foot.of, H + 9 * foot.of);
    }

  private:
    static constexpr int most_iterations = 12;

    /// psi = phi - w with its derivatives at a place, and phi there.
    struct Level {
        double phi, psi;
        Vec3 m;
        Mat3 M;
    };

    /// A point on its way to the surface: at y = x - lambda m(y) when it is found.
    struct Foot {
        int of;
        Vec3 x, y;
        Level first, level;  // at x, at y
        double lambda = 0.0;
        bool last = false, found = false;
    };

    void of_tool(int count, const double* x, Nearby* nearby, double* g, double* n, double* H) const {
        if (nearby == nullptr)
            tool_->gap(count, x, g, n, H);
        else
            tool_->gap_again(count, x, nearby, g, n, H);
    }

    Level at(const Vec3& x, double g, const double* n, const double* H) const {
        const FieldValue field = field_.at(x);
        Level level{g, g - field.w, {}, {}};
        for (int k = 0; k < 3; ++k) level.m[k] = n[k] - field.slope[k];
        for (int k = 0; k < 9; ++k) level.M.a[k] = H[k] - field.curvature.a[k];
        return level;
    }

    /// Newton's method for y + lambda m(y) = x, psi(y) = 0, all points together: the tool may be a function of a user. eq. (4.265)
    void find(std::vector<Foot>& feet, Nearby* nearby) const {
        std::vector<std::size_t> moving(feet.size());
        for (std::size_t i = 0; i < feet.size(); ++i) moving[i] = i;
        std::vector<Vec3> y, n;
        std::vector<double> g;
        std::vector<Mat3> H;
        for (int iteration = 0; iteration < most_iterations && !moving.empty(); ++iteration) {
            std::vector<std::size_t> next;
            y.clear();
            for (const std::size_t i : moving)
                if (step(feet[i])) next.push_back(i), y.push_back(feet[i].y);
            moving.swap(next);
            if (moving.empty()) break;
            g.resize(y.size()), n.resize(y.size()), H.resize(y.size());
            if (nearby == nullptr)
                tool_->gap(static_cast<int>(y.size()), y[0].data(), g.data(), n[0].data(), H[0].a.data());
            else
                for (std::size_t i = 0; i < y.size(); ++i)
                    tool_->gap_again(1, y[i].data(), nearby + feet[moving[i]].of, &g[i], n[i].data(), H[i].a.data());
            next.clear();
            for (std::size_t i = 0; i < y.size(); ++i) {
                Foot& foot = feet[moving[i]];
                foot.level = at(y[i], g[i], n[i].data(), H[i].a.data());
                if (foot.last)
                    foot.found = true;
                else
                    next.push_back(moving[i]);
            }
            moving.swap(next);
        }
    }

    /// One step; false if there is none. The step after a short one is below round-off.
    bool step(Foot& foot) const {
        const Level& at = foot.level;
        Mat3 A;
        Vec3 r;
        for (int i = 0; i < 3; ++i) {
            r[i] = foot.y[i] + foot.lambda * at.m[i] - foot.x[i];
            for (int j = 0; j < 3; ++j) A(i, j) = (i == j) + foot.lambda * at.M(i, j);
        }
        const double size = det(A);
        if (!(size > 1e-3)) return false;  // at a centre of curvature
        const Mat3 inverse_A = inverse(A);
        const Vec3 Ar = product(inverse_A, r), Am = product(inverse_A, at.m);
        const double change = (at.psi - dot(at.m, Ar)) / dot(at.m, Am);
        Vec3 d;
        for (int i = 0; i < 3; ++i) d[i] = -Ar[i] - Am[i] * change;
        const double length = std::sqrt(dot(d, d));
        if (!(length < 8.0 * (field_.spacing() + field_.most() - field_.least()))) return false;
        for (int i = 0; i < 3; ++i) foot.y[i] += d[i];
        foot.lambda += change;
        foot.last = length < 1e-8 * field_.spacing();
        return true;
    }

    /// Distance, normal and Hessian: S = P M P/|m| at the foot, H = (1 + g S)^-1 S. A point without a foot, deep in the tool or
    /// near a centre of curvature, has the first approximation, between the bounds of its distance. eq. (4.266)
    void write(const Foot& foot, double* g, double* n, double* H) const {
        const double least = foot.first.phi - field_.most(), most = foot.first.phi - field_.least();
        double distance = foot.level.psi / std::sqrt(dot(foot.level.m, foot.level.m));
        const Vec3 normal = normalised(foot.level.m);
        for (int i = 0; i < 3; ++i) distance += (foot.x[i] - foot.y[i]) * normal[i];
        const double round_off = 1e-9 * field_.spacing();
        if (foot.found && distance >= least - round_off && distance <= most + round_off) {
            *g = distance;
            write_level(foot.level, distance, n, H);
        } else {
            *g = std::clamp(foot.first.psi / std::sqrt(dot(foot.first.m, foot.first.m)), least, most);
            write_level(foot.first, 0.0, n, H);
        }
    }

    /// Normal, and Hessian at a distance from the surface.
    static void write_level(const Level& at, double distance, double* n, double* H) {
        const double length = std::sqrt(dot(at.m, at.m));
        const Vec3 normal = normalised(at.m), Mn = product(at.M, normal);
        const double nMn = dot(normal, Mn);
        Mat3 S, B;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                S(i, j) = (at.M(i, j) - normal[i] * Mn[j] - Mn[i] * normal[j] + normal[i] * nMn * normal[j]) / length;
                B(i, j) = (i == j) + distance * S(i, j);
            }
        const Mat3 found = product(inverse(B), S);
        for (int i = 0; i < 3; ++i) {
            n[i] = normal[i];
            for (int j = 0; j < 3; ++j) H[3 * i + j] = 0.5 * (found(i, j) + found(j, i));
        }
    }

    std::shared_ptr<const Surface> tool_;
    SplineField field_;
};

}  // namespace umform
