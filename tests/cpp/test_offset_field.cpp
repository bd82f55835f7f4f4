// Tools grown by a field: the surface is phi = w, distance, normal and Hessian are those of it, bounds hold.
#include "check.hpp"
#include "umform/surfaces/cylinder.hpp"
#include "umform/surfaces/offset_field.hpp"
#include "umform/surfaces/plane.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

template <class Shape>
std::shared_ptr<Surface> tool(const Shape& shape) {
    return std::make_shared<SurfaceOf<Shape>>(shape);
}

Gap gap_of(const Surface& surface, const Vec3& x) {
    Gap gap;
    surface.gap(1, x.data(), &gap.g, gap.n.data(), gap.H.a.data());
    return gap;
}

const Vec3 along = normalised({2, 1, 0}), across = normalised({-1, 2, 0}), up{0, 0, 1};

std::vector<double> waves(int count, double height) {
    std::vector<double> c(count);
    for (int i = 0; i < count; ++i) c[i] = height * std::sin(1.7 * i + 0.3);
    return c;
}

/// One, two and three directions.
std::vector<SplineField> fields(double height) {
    return {SplineField{{{along, -8, 3, 6}}, waves(6, height)},
            SplineField{{{along, -8, 3, 6}, {across, -9, 4, 5}}, waves(30, height)},
            SplineField{{{along, -8, 3, 6}, {across, -9, 4, 5}, {up, -3, 5, 3}}, waves(90, height)}};
}

void slopes_and_curvatures() {
    const double h = 1e-5;
    for (const SplineField& field : fields(0.3))
        for (const Vec3& x : {Vec3{0.3, 0.2, 0.1}, Vec3{-4.1, 3.3, 2.2}, Vec3{-9.3, 2, 1}, Vec3{12, 9, -9}}) {
            const FieldValue at = field.at(x);
            CHECK(at.w <= field.most() && at.w >= field.least());
            for (int k = 0; k < 3; ++k) {
                Vec3 ahead = x, behind = x;
                ahead[k] += h, behind[k] -= h;
                const FieldValue plus = field.at(ahead), minus = field.at(behind);
                CHECK_NEAR(at.slope[k], (plus.w - minus.w) / (2 * h), 1e-9);
                for (int i = 0; i < 3; ++i)
                    CHECK_NEAR(at.curvature(i, k), (plus.slope[i] - minus.slope[i]) / (2 * h), 1e-9);
            }
        }
}

/// A polynomial of degree one is met, ends are constant, and a coefficient counts where it stands.
void values_of_a_spline() {
    const SplineField line{{{{1, 0, 0}, 2, 0.5, 7}}, {1, 2, 3, 4, 5, 6, 7}};
    CHECK_NEAR(line.at({3.3, 5, 5}).w, 1 + (3.3 - 2) / 0.5, 1e-14);
    CHECK_NEAR(line.at({3.3, 5, 5}).slope[0], 2.0, 1e-13);
    for (const double x : {5.5, 7.0, 1e30}) {
        CHECK_NEAR(line.at({x, 0, 0}).w, 7.0, 1e-14);
        CHECK_NEAR(line.at({x, 0, 0}).slope[0], 0.0, 1e-13);
        CHECK_NEAR(line.at({x, 0, 0}).curvature(0, 0), 0.0, 1e-12);
    }
    const SplineField one{{{{1, 0, 0}, 0, 1, 3}, {{0, 1, 0}, 0, 1, 5}}, {0, 0, 0, 0, 0, 0, 0, 6, 0, 0, 0, 0, 0, 0, 0}};
    CHECK_NEAR(one.at({1, 2, 0}).w, 6.0 * 4.0 / 9.0, 1e-14);
}

/// g against the level set, n against differences of g, H against differences of n; the foot lies on the surface.
void distances() {
    const std::vector<std::shared_ptr<Surface>> tools{
        tool(Plane{{0, 0, 0}, {0, 0, 1}}), tool(Sphere{{0, 0, -9}, 9, false}), tool(Sphere{{0, 0, 9}, 9, true}),
        tool(Cylinder{{0, 0, -7}, along, 7, false})};
    const double h = 1e-5;
    for (const auto& base : tools)
        for (const SplineField& field : fields(0.2)) {
            const OffsetByField grown{base, field};
            for (const Vec3& x : {Vec3{0.3, 0.2, 0.1}, Vec3{1.1, -0.4, 0.6}, Vec3{-0.7, 1.2, -0.3}}) {
                const Gap at = gap_of(grown, x);
                CHECK_NEAR(dot(at.n, at.n), 1.0, 1e-14);
                Vec3 foot;
                for (int k = 0; k < 3; ++k) foot[k] = x[k] - at.g * at.n[k];
                CHECK_NEAR(gap_of(*base, foot).g, field.at(foot).w, 1e-13);
                for (int k = 0; k < 3; ++k) {
                    Vec3 ahead = x, behind = x;
                    ahead[k] += h, behind[k] -= h;
                    const Gap plus = gap_of(grown, ahead), minus = gap_of(grown, behind);
                    CHECK_NEAR(at.n[k], (plus.g - minus.g) / (2 * h), 1e-9);
                    double Hn = 0.0;
                    for (int i = 0; i < 3; ++i) {
                        CHECK_NEAR(at.H(i, k), (plus.n[i] - minus.n[i]) / (2 * h), 1e-8);
                        CHECK_NEAR(at.H(i, k), at.H(k, i), 1e-15);
                        Hn += at.H(k, i) * at.n[i];
                    }
                    CHECK_NEAR(Hn, 0.0, 1e-13);
                }
            }
        }
}

/// Equal coefficients are an offset, outward if they are positive.
void equal_coefficients() {
    const auto ball = tool(Sphere{{1, 2, 3}, 5, false});
    const OffsetByField grown{ball, SplineField{{{along, -8, 3, 6}, {up, -9, 4, 5}}, std::vector<double>(30, 0.25)}};
    for (const Vec3& x : {Vec3{1, 2, 8.5}, Vec3{4, 4, 7}}) {
        const Gap at = gap_of(grown, x), larger = Sphere{{1, 2, 3}, 5.25, false}.gap(x);
        CHECK_NEAR(at.g, larger.g, 1e-14);
        for (int i = 0; i < 3; ++i) CHECK_NEAR(at.n[i], larger.n[i], 1e-14);
        for (int i = 0; i < 9; ++i) CHECK_NEAR(at.H.a[i], larger.H.a[i], 1e-13);
    }
}

/// Far from the tool, and where no foot is found, the gap is at most `above` more than the distance, and of its sign.
void bounds() {
    const auto ball = tool(Sphere{{0, 0, 0}, 7, true});
    const SplineField field = fields(0.2)[1];
    const OffsetByField grown{ball, field};
    CHECK_NEAR(grown.above(), field.most() - field.least(), 1e-15);
    for (double r = 0.1; r < 13.0; r += 0.37)
        for (const Vec3& e : {along, across, up}) {
            const Vec3 x{r * e[0], r * e[1], r * e[2]};
            const double phi = gap_of(*ball, x).g, g = gap_of(grown, x).g;
            CHECK(g >= phi - field.most() - 1e-8 && g <= phi - field.least() + 1e-8);
            if (r < 3.0) CHECK_NEAR(g, phi - field.most(), 1e-15);
            if (r > 11.0) CHECK_NEAR(g, phi - field.least(), 1e-15);
        }
}

}  // namespace

int main() {
    slopes_and_curvatures();
    values_of_a_spline();
    distances();
    equal_coefficients();
    bounds();
    return report("offset field");
}
