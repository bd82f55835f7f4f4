// Laws of friction: the largest tangential traction.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Largest tangential traction, and its derivatives with respect to the pressure and to the distance slid.
struct Bound {
    double value = 0.0, by_pressure = 0.0, by_slip = 0.0;
};

/// Asked at a place with a pressure that is not negative, the distance slid so far, and z, where it is in the frame of the tool.
class FrictionLaw {
  public:
    virtual ~FrictionLaw() = default;
    virtual Bound bound(double pressure, double slip, const Vec3& z) const = 0;
};

/// min(mu(p, slip) p, cap) with mu = mu(p) (k + (1 - k) exp(-slip/d)): mu(p) is piecewise linear and constant beyond its ends, k the
/// kinetic over the static coefficient. eq. (4.48)
class CoulombFriction final : public FrictionLaw {
  public:
    std::vector<double> pressure, mu;  // the table, ascending; one entry is a constant coefficient
    double kinetic = 1.0, decay = 0.0;
    double cap = std::numeric_limits<double>::infinity();

    Bound bound(double p, double slip, const Vec3&) const override {
        double coefficient = mu.back(), slope = 0.0;
        const auto above = std::upper_bound(pressure.begin(), pressure.end(), p);
        if (above == pressure.begin()) {
            coefficient = mu.front();
        } else if (above != pressure.end()) {
            const auto i = above - pressure.begin();
            slope = (mu[i] - mu[i - 1]) / (pressure[i] - pressure[i - 1]);
            coefficient = mu[i - 1] + slope * (p - pressure[i - 1]);
        }
        double factor = 1.0, factor_slope = 0.0;
        if (decay > 0.0) {
            const double fading = (1.0 - kinetic) * std::exp(-slip / decay);
            factor = kinetic + fading, factor_slope = -fading / decay;
        }
        const double s = factor * coefficient * p;
        if (s >= cap) return {cap, 0.0, 0.0};
        return {s, factor * (coefficient + slope * p), factor_slope * coefficient * p};
    }
};

/// Other laws within boxes in the frame of the tool; the first box that a place is in counts.
class FrictionByRegion final : public FrictionLaw {
  public:
    struct Region {
        Vec3 lower, upper;
        std::shared_ptr<const FrictionLaw> law;
    };
    std::vector<Region> regions;
    std::shared_ptr<const FrictionLaw> elsewhere;

    Bound bound(double p, double slip, const Vec3& z) const override {
        for (const Region& region : regions) {
            bool inside = true;
            for (int k = 0; k < 3; ++k) inside = inside && region.lower[k] <= z[k] && z[k] <= region.upper[k];
            if (inside) return region.law->bound(p, slip, z);
        }
        return elsewhere->bound(p, slip, z);
    }
};

/// A function of a user; derivatives by central differences.
class FrictionFunction final : public FrictionLaw {
  public:
    using Function = std::function<double(double pressure, double slip, const Vec3& z)>;
    explicit FrictionFunction(Function function) : function_(std::move(function)) {}

    Bound bound(double p, double slip, const Vec3& z) const override {
        const double dp = std::max(p, 1.0) * part, ds = std::max(slip, 1.0) * part;
        const double p0 = std::max(p - dp, 0.0), s0 = std::max(slip - ds, 0.0);
        return {function_(p, slip, z), (function_(p + dp, slip, z) - function_(p0, slip, z)) / (p + dp - p0),
                (function_(p, slip + ds, z) - function_(p, s0, z)) / (slip + ds - s0)};
    }

  private:
    static constexpr double part = 1e-6;
    Function function_;
};

}  // namespace umform
