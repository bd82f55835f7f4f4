// What friction needs of geometry: how far a place has slid along the tool, and how vectors along the tool are carried with it.
#pragma once

#include "umform/contact/concept.hpp"

namespace umform {

/// Way of a place along the tool since the converged state, or since it touched: D = w P (x - x_n). eqs. (4.43), (4.44)
class Slide {
  public:
    /// From where the place was in the frame of the tool; `held` says whether the tool held it there.
    Slide(const Place& place, const Vec3& from, bool held) : place_(place) {
        const Vec3 &n = place.n, start = place.pose.to_space(from);
        for (int k = 0; k < 3; ++k) way_[k] = place.x[k] - start[k];
        along_ = dot(n, way_);
        Hway_ = product(place.H, way_);
        if (!held && along_ < place.gap) {  // it touched on the way
            w_ = 0.0;
            if (place.gap <= 0.0) {
                w_ = place.gap / along_;
                for (int k = 0; k < 3; ++k) dw_[k] = (n[k] - w_ * (n[k] + Hway_[k])) / along_;
            }
        }
        for (int k = 0; k < 3; ++k) D[k] = w_ * (way_[k] - n[k] * along_);
        length = std::sqrt(dot(D, D));
    }

    Vec3 D;
    double length;

    /// dD_i/dx_j
    double d(int i, int j) const {
        const Vec3& n = place_.n;
        const double along_the_tool = (i == j ? 1.0 : 0.0) - n[i] * n[j] - along_ * place_.H(i, j) - n[i] * Hway_[j];
        return w_ * along_the_tool + (way_[i] - n[i] * along_) * dw_[j];
    }

    /// d|D|/dx_j
    double d_length(int j) const {
        if (!(length > 0.0)) return 0.0;
        return (D[0] * d(0, j) + D[1] * d(1, j) + D[2] * d(2, j)) / length;
    }

  private:
    const Place& place_;
    Vec3 way_, Hway_, dw_{};
    double along_, w_ = 1.0;
};

/// A vector along the tool in the converged state, carried by the rotation that takes the normal there to the one here:
/// R a = a - (n.a) / (1 + n.n_n) (n + n_n). Without a normal there it is projected, P a. eq. (4.45)
class Carried {
  public:
    Carried(const Place& place, const Vec3& a, const Vec3& normal, bool held)
        : place_(place), a_(place.pose.turn(a)), before_(held ? place.pose.turn(normal) : place.n), held_(held) {
        const Vec3& n = place.n;
        inverse_ = 1.0 / (1.0 + dot(n, before_));
        part_ = dot(n, a_) * inverse_;
        for (int k = 0; k < 3; ++k) value[k] = a_[k] - part_ * (n[k] + before_[k]);
        Ha_ = product(place.H, a_), Hbefore_ = product(place.H, before_);
    }

    Vec3 value;

    /// d(R a)_i/dx_j, with dn = H dx
    double d(int i, int j) const {
        const Vec3& n = place_.n;
        const double d_part = held_ ? inverse_ * (Ha_[j] - part_ * Hbefore_[j]) : 0.5 * Ha_[j];
        const double sum = n[i] + before_[i], d_sum = (held_ ? 1.0 : 2.0) * place_.H(i, j);
        return -d_part * sum - part_ * d_sum;
    }

  private:
    const Place& place_;
    Vec3 a_, before_, Ha_, Hbefore_;
    bool held_;
    double inverse_, part_;
};

/// The same the other way round: what is carried to `t` at the place.
inline Vec3 carried_back(const Place& place, const Vec3& t, const Vec3& normal, bool held) {
    Vec3 a = t;
    if (held) {
        const Vec3 before = place.pose.turn(normal);
        const double part = dot(before, t) / (1.0 + dot(place.n, before));
        for (int k = 0; k < 3; ++k) a[k] = t[k] - part * (place.n[k] + before[k]);
    }
    return place.pose.turn_back(a);
}

}  // namespace umform
