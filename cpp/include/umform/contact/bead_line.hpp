// The line of a draw bead on a tool: a polyline in its frame, and how a place lies to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// The place of the line that is nearest to a place.
struct Foot {
    bool within = false;  // if not, the place is farther than the band is wide
    Vec3 offset;          // from the foot to the place
    Vec3 along;           // unit vector of the segment
    bool moves;           // whether the foot follows the place along the segment; at a corner it stays
    Vec3 tangent, turn;   // unit tangent, which turns smoothly about corners, and its derivative by the length
    double end, d_end;    // 1 on the line, falling to 0 over its ends, and its derivative by the length
};

/// Straight segments between points; tangents are interpolated within half a width of a corner, or half a segment where that is
/// shorter. An open line fades over half a width before and behind each end, so that its resultant is that of its length. eq. (4.104)
class BeadLine {
  public:
    BeadLine(std::vector<Vec3> points, bool closed, double half_width)
        : points_(std::move(points)), closed_(closed), half_width_(half_width) {
        if (closed_ && !points_.empty()) points_.push_back(points_.front());
        if (points_.size() < 2) throw std::invalid_argument("the line of a bead has at least two points");
        start_.push_back(0.0);
        for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
            const Vec3 way = difference(points_[i + 1], points_[i]);
            const double length = std::sqrt(dot(way, way));
            if (!(length > 0.0)) throw std::invalid_argument("two points of the line of a bead are the same");
            along_.push_back({way[0] / length, way[1] / length, way[2] / length});
            start_.push_back(start_.back() + length);
        }
        lower_ = upper_ = points_[0];
        for (const Vec3& point : points_)
            for (int k = 0; k < 3; ++k)
                lower_[k] = std::min(lower_[k], point[k]), upper_[k] = std::max(upper_[k], point[k]);
    }

    double length() const { return start_.back(); }

    /// Foot of a place whose distance along the tool may be the half width, and off the tool `reach`.
    Foot foot(const Vec3& z, double reach) const {
        Foot foot;
        const double farthest = half_width_ + reach;
        for (int k = 0; k < 3; ++k)
            if (!(z[k] >= lower_[k] - farthest && z[k] <= upper_[k] + farthest)) return foot;
        double least = farthest * farthest, at = 0.0;
        int nearest = -1;
        for (int i = 0; i < segments(); ++i) {
            const Vec3 from = difference(z, points_[i]);
            const double wanted = dot(from, along_[i]);
            const double low = !closed_ && i == 0 ? -half_width_ : 0.0;
            const double high = size(i) + (!closed_ && i + 1 == segments() ? half_width_ : 0.0);
            const double u = std::clamp(wanted, low, high);
            Vec3 offset;
            for (int k = 0; k < 3; ++k) offset[k] = from[k] - u * along_[i][k];
            const double square = dot(offset, offset);
            if (!(square < least)) continue;
            least = square, nearest = i, at = u;
            foot.offset = offset, foot.moves = u == wanted;
        }
        if (nearest < 0) return foot;
        foot.within = true;
        foot.along = along_[nearest];
        set_tangent(nearest, at, foot);
        set_end(start_[nearest] + at, foot);
        return foot;
    }

  private:
    static Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
    int segments() const { return static_cast<int>(along_.size()); }
    double size(int i) const { return start_[i + 1] - start_[i]; }

    void set_tangent(int i, double u, Foot& foot) const {
        foot.tangent = along_[i], foot.turn = {};
        const bool second_half = u > 0.5 * size(i);
        const int other = second_half ? i + 1 : i - 1;
        if (!closed_ && (other < 0 || other >= segments())) return;
        const int neighbour = (other + segments()) % segments();
        const double rounded = std::min({half_width_, 0.5 * size(i), 0.5 * size(neighbour)});
        const double beside = second_half ? size(i) - u : u;  // way to the corner
        if (beside >= rounded) return;
        const double part = 0.5 * (1.0 - beside / rounded), slope = (second_half ? 0.5 : -0.5) / rounded;
        const Vec3 change = difference(along_[neighbour], along_[i]);
        for (int k = 0; k < 3; ++k) foot.tangent[k] += part * change[k];
        const double length = std::sqrt(dot(foot.tangent, foot.tangent));
        for (double& value : foot.tangent) value /= length;
        const double in_line = dot(foot.tangent, change);
        for (int k = 0; k < 3; ++k) foot.turn[k] = slope / length * (change[k] - in_line * foot.tangent[k]);
    }

    void set_end(double sigma, Foot& foot) const {
        foot.end = 1.0, foot.d_end = 0.0;
        if (closed_) return;
        const double before = std::clamp(sigma / half_width_, -1.0, 1.0);
        const double behind = std::clamp((length() - sigma) / half_width_, -1.0, 1.0);
        foot.end = step(before) * step(behind);
        foot.d_end = (hump(before) * step(behind) - step(before) * hump(behind)) / half_width_;
    }

    /// From 0 at -1 to 1 at 1, the integral of hump.
    static double step(double t) { return 0.5 + 0.9375 * (t - t * t * t * (2.0 / 3.0 - t * t / 5.0)); }
    static double hump(double t) { return 0.9375 * (1.0 - t * t) * (1.0 - t * t); }

    std::vector<Vec3> points_,
        along_;                  // of a closed line the first point once more at the end; unit vectors of segments
    std::vector<double> start_;  // length of the line up to each point
    bool closed_;
    double half_width_;
    Vec3 lower_, upper_;  // of all points
};

}  // namespace umform
