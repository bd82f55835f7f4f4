// Foot of a point on a curved patch: Newton's method in the triangle of its parameters.
#pragma once

#include <limits>

#include "umform/surfaces/quartic_patch.hpp"

namespace umform {

/// Nearest place of a patch.
struct PatchFoot {
    PatchParameter p;
    PatchPoint at;
    double square;  // of the distance
};

/// Least distance from x to a patch: Newton's method with the matrix of eq. (4.166), kept inside of the triangle.
class FootSearch {
  public:
    FootSearch(const QuarticPatch& patch, const Vec3& x) : patch_(patch), x_(x) {}

    PatchFoot from(const PatchParameter& start) {
        move_to(start);
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            differentiate();
            const Step step = admissible_step();
            const double size = std::abs(step.u) + std::abs(step.v);
            if (size == 0.0) break;
            if (size < smallest_step && stays(step)) {
                move_by(step);
                break;
            }
            const bool last = size < last_step;
            if (!descend(step, last) || last) break;
        }
        return foot_;
    }

  private:
    using Step = PatchParameter;
    static constexpr int most_iterations = 40;
    /// Quadratic convergence: what is left after a step of this size is round-off, patches being nearly flat.
    static constexpr double last_step = 1e-6;
    /// Square and cube of such a step are round-off.
    static constexpr double smallest_step = 1e-8;

    void move_to(const PatchParameter& p) {
        foot_.p = p;
        foot_.at = patch_.at(p);
        d_ = difference(x_, foot_.at.S);
        foot_.square = dot(d_, d_);
    }

    /// A small step, by Taylor's series.
    void move_by(const Step& step) {
        PatchPoint& at = foot_.at;
        for (int k = 0; k < 3; ++k) {
            at.S[k] += step.u * at.Su[k] + step.v * at.Sv[k];
            at.Su[k] += step.u * at.Suu[k] + step.v * at.Suv[k];
            at.Sv[k] += step.u * at.Suv[k] + step.v * at.Svv[k];
        }
        foot_.p.u += step.u, foot_.p.v += step.v;
        d_ = difference(x_, at.S);
        foot_.square = dot(d_, d_);
    }
    /// Whether a step ends inside of the triangle, off its border.
    bool stays(const Step& step) const {
        const double u = foot_.p.u + step.u, v = foot_.p.v + step.v;
        return foot_.p.u > 0.0 && foot_.p.v > 0.0 && u > 0.0 && v > 0.0 && u + v < 1.0;
    }

    /// Slope and matrix of half the square of the distance; without the second derivatives where it is not convex.
    void differentiate() {
        const PatchPoint& at = foot_.at;
        gu_ = -dot(d_, at.Su), gv_ = -dot(d_, at.Sv);
        const double auu = dot(at.Su, at.Su), auv = dot(at.Su, at.Sv), avv = dot(at.Sv, at.Sv);
        uu_ = auu - dot(d_, at.Suu), uv_ = auv - dot(d_, at.Suv), vv_ = avv - dot(d_, at.Svv);
        if (uu_ > 0.0 && vv_ > 0.0 && uu_ * vv_ - uv_ * uv_ > 1e-3 * (auu * avv - auv * auv)) return;
        uu_ = auu, uv_ = auv, vv_ = avv;
    }

    /// The step of Newton, or along an edge if it leaves the triangle from there; none at a corner that is the foot.
    Step admissible_step() const {
        const double det = uu_ * vv_ - uv_ * uv_;
        const Step full{(uv_ * gv_ - vv_ * gu_) / det, (uv_ * gu_ - uu_ * gv_) / det};
        if (!leaves(full)) return full;
        Step best{0.0, 0.0};
        double gain = 0.0;
        const auto along = [&](double u, double v) {
            const double slope = gu_ * u + gv_ * v, curvature = uu_ * u * u + 2.0 * uv_ * u * v + vv_ * v * v;
            const Step step{-slope / curvature * u, -slope / curvature * v};
            const double found = slope * slope / curvature;
            if (found > gain && !leaves(step)) gain = found, best = step;
        };
        const auto& [u, v] = foot_.p;
        if (v == 0.0) along(1.0, 0.0);
        if (u == 0.0) along(0.0, 1.0);
        if (u + v == 1.0) along(-1.0, 1.0);
        return best;
    }

    bool leaves(const Step& step) const {
        const auto& [u, v] = foot_.p;
        return (u == 0.0 && step.u < 0.0) || (v == 0.0 && step.v < 0.0) || (u + v == 1.0 && step.u + step.v > 0.0);
    }

    /// Goes along a step, up to the border of the triangle, less far while the distance grows. Whether it moved.
    bool descend(const Step& step, bool last) {
        const PatchFoot before = foot_;
        const Vec3 d_before = d_;
        double part = 1.0;
        for (int halving = 0; halving < 10; ++halving, part *= 0.5) {
            move_to(inside(before.p, {part * step.u, part * step.v}));
            if (last || foot_.square <= before.square * (1.0 + 1e-9)) return true;
        }
        foot_ = before, d_ = d_before;
        return false;
    }

    /// The end of a step, or where it meets the border: exactly on it.
    static PatchParameter inside(const PatchParameter& p, const Step& step) {
        double part = 1.0;
        int border = -1;
        const auto limit = [&](double room, double speed, int which) {
            if (speed > 0.0 && room < part * speed) part = room / speed, border = which;
        };
        limit(p.u, -step.u, 0);
        limit(p.v, -step.v, 1);
        limit(1.0 - p.u - p.v, step.u + step.v, 2);
        double u = std::max(p.u + part * step.u, 0.0), v = std::max(p.v + part * step.v, 0.0);
        if (border == 0) u = 0.0;
        if (border == 1) v = 0.0;
        if (border == 2 || u + v > 1.0 || (p.u + p.v == 1.0 && step.u + step.v == 0.0)) {
            v = std::min(v, 1.0);
            u = 1.0 - v;
        }
        return {u, v};
    }

    const QuarticPatch& patch_;
    Vec3 x_, d_{};
    PatchFoot foot_{};
    double gu_ = 0.0, gv_ = 0.0, uu_ = 0.0, uv_ = 0.0, vv_ = 0.0;
};

}  // namespace umform
