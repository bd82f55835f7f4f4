// What a rigid tool is to contact: one function of position.
#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <memory>

#include "umform/algebra/tensor.hpp"
#include "umform/surfaces/nearby.hpp"

namespace umform {

/// Signed distance g (negative inside the tool), unit normal n = grad g, Hessian H of the distance.
struct Gap {
    double g;
    Vec3 n;
    Mat3 H;
};

/// A surface that `is_distance` changes its gap by no more than the way of the point: contact leaves out what is far then.
template <class S>
concept ToolSurface = requires(const S& surface, const Vec3& x) {
    { S::is_distance } -> std::convertible_to<bool>;
    { surface.gap(x) } -> std::same_as<Gap>;
};

/// A surface as contact sees it: one virtual call for all points.
class Surface {
  public:
    virtual ~Surface() = default;
    /// Arrays x [count][3], g [count], n [count][3], H [count][3][3].
    virtual void gap(int count, const double* x, double* g, double* n, double* H) const = 0;
    /// Whether `gap_again` gains from what it has found before.
    virtual bool searches() const { return false; }
    /// The same values to the last bit for points that are asked for again and again, with what was found near to each.
    virtual void gap_again(int count, const double* x, Nearby*, double* g, double* n, double* H) const {
        gap(count, x, g, n, H);
    }
    virtual bool is_distance() const = 0;
    /// By how much a gap may be more than the distance; the way of the point bounds the rest of its change.
    virtual double above() const { return 0.0; }
    /// Whether several threads may ask at a time, each for some of the points.
    virtual bool is_concurrent() const = 0;
};

template <ToolSurface Shape>
class SurfaceOf final : public Surface {
  public:
    explicit SurfaceOf(Shape shape) : shape_(shape) {}
    bool is_distance() const override { return Shape::is_distance; }
    bool is_concurrent() const override { return true; }
    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        for (int q = 0; q < count; ++q) {
            const Gap at = shape_.gap({x[3 * q], x[3 * q + 1], x[3 * q + 2]});
            g[q] = at.g;
            std::copy(at.n.begin(), at.n.end(), n + 3 * q);
            std::copy(at.H.a.begin(), at.H.a.end(), H + 9 * q);
        }
    }

  private:
    Shape shape_;
};

/// A surface from any function of arrays, a user's own for instance: it may be scaled, and is evaluated once for all points.
class SurfaceFromFunction final : public Surface {
  public:
    using Function = std::function<void(int, const double*, double*, double*, double*)>;
    explicit SurfaceFromFunction(Function function) : function_(std::move(function)) {}
    bool is_distance() const override { return false; }
    bool is_concurrent() const override { return false; }
    void gap(int count, const double* x, double* g, double* n, double* H) const override {
        function_(count, x, g, n, H);
    }

  private:
    Function function_;
};

/// Distance to the inside of a closed shape (the sheet lies in a bore or a bowl) is the negative of the outside one.
inline Gap turned_inside(Gap gap) {
    gap.g = -gap.g;
    for (double& value : gap.n) value = -value;
    for (double& value : gap.H.a) value = -value;
    return gap;
}

}  // namespace umform
