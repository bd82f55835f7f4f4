// Kinematics of friction: the slip of a point along the tool, and the transport of tangential vectors with it.
#pragma once

#include "umform/contact/concept.hpp"

namespace umform {

/// Which way the tool faces at a place: unit normal, its length before, and its derivative dn_i/dx_j, which is H of a distance. A
/// function of a user may be a scaled one.
struct Facing {
    Vec3 n;
    Mat3 dn;
    double scale = 1.0;

    explicit Facing(const Place& place) : n(place.n), dn(place.H) {
        const double square = dot(n, n);
        if (std::abs(square - 1.0) < 1e-12) return;
        scale = std::sqrt(square);
        for (double& value : n) value /= scale;
        const Vec3 Hn = product(place.H, n);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) dn(i, j) = (place.H(i, j) - n[i] * Hn[j]) / scale;
    }
};

/// Way of a place along the tool since the converged state, or since it touched: D = w P (x - x_n). eqs. (4.43), (4.44)
class Slide {
  public:
    /// From where the place was in the frame of the tool; `held` says whether the tool held it there.
    Slide(const Place& place, const Facing& facing, const Vec3& from, bool held) : facing_(facing) {
        const Vec3 start = place.pose.to_space(from);
        for (int k = 0; k < 3; ++k) way_[k] = place.x[k] - start[k];
        along_ = dot(facing.n, way_);
        for (int j = 0; j < 3; ++j)
            turning_[j] = facing.dn(0, j) * way_[0] + facing.dn(1, j) * way_[1] + facing.dn(2, j) * way_[2];
        const double approach = dot(place.n, way_);
        if (!held && approach < place.gap) {  // it touched on the way
            w_ = 0.0;
            if (place.gap <= 0.0) {
                w_ = place.gap / approach;
                const Vec3 Hway = product(place.H, way_);
                for (int k = 0; k < 3; ++k) dw_[k] = (place.n[k] - w_ * (place.n[k] + Hway[k])) / approach;
            }
        }
        for (int k = 0; k < 3; ++k) D[k] = w_ * (way_[k] - facing.n[k] * along_);
        length = std::sqrt(dot(D, D));
    }

    Vec3 D;
    double length;

    /// dD_i/dx_j
    double d(int i, int j) const {
        const Vec3& n = facing_.n;
        const double along_the_tool =
            (i == j ? 1.0 : 0.0) - n[i] * n[j] - along_ * facing_.dn(i, j) - n[i] * turning_[j];
        return w_ * along_the_tool + (way_[i] - n[i] * along_) * dw_[j];
    }

    /// d|D|/dx_j
    double d_length(int j) const {
        if (!(length > 0.0)) return 0.0;
        return (D[0] * d(0, j) + D[1] * d(1, j) + D[2] * d(2, j)) / length;
    }

  private:
    const Facing& facing_;
    Vec3 way_, turning_, dw_{};  // turning: derivative of n . way with the way held
    double along_, w_ = 1.0;
};

/// A vector along the tool in the converged state, carried by the rotation that takes the normal there to the one here:
/// R a = a - (n.a) / (1 + n.n_n) (n + n_n). Without a normal there it is projected, P a. eq. (4.45)
class Carried {
  public:
    Carried(const Pose& pose, const Facing& facing, const Vec3& a, const Vec3& normal, bool held)
        : facing_(facing), a_(pose.turn(a)), before_(held ? pose.turn(normal) : facing.n), held_(held) {
        const Vec3& n = facing.n;
        inverse_ = 1.0 / (1.0 + dot(n, before_));
        part_ = dot(n, a_) * inverse_;
        for (int k = 0; k < 3; ++k) value[k] = a_[k] - part_ * (n[k] + before_[k]);
    }

    Vec3 value;

    /// d(R a)_i/dx_j
    double d(int i, int j) const {
        double of_a = 0.0, of_before = 0.0;
        for (int k = 0; k < 3; ++k) of_a += a_[k] * facing_.dn(k, j), of_before += before_[k] * facing_.dn(k, j);
        const double d_part = inverse_ * (of_a - (held_ ? part_ * of_before : 0.0));
        return -d_part * (facing_.n[i] + before_[i]) - (held_ ? 1.0 : 2.0) * part_ * facing_.dn(i, j);
    }

  private:
    const Facing& facing_;
    Vec3 a_, before_;
    bool held_;
    double inverse_, part_;
};

/// The inverse: the vector that is transported to `t` at the point, in the frame of the tool.
inline Vec3 carried_back(const Pose& pose, const Facing& facing, const Vec3& t, const Vec3& normal, bool held) {
    Vec3 a = t;
    if (held) {
        const Vec3 before = pose.turn(normal);
        const double part = dot(before, t) / (1.0 + dot(facing.n, before));
        for (int k = 0; k < 3; ++k) a[k] = t[k] - part * (facing.n[k] + before[k]);
    }
    return pose.turn_back(a);
}

}  // namespace umform
