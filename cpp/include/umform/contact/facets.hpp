// Frictionless contact of element faces with one rigid tool, by penalty and multipliers, integrated over the reference
// area.
#pragma once

#include "umform/assembly/colours.hpp"
#include "umform/assembly/target.hpp"
#include "umform/assembly/threads.hpp"
#include "umform/elements/kinematics.hpp"
#include "umform/elements/quadrature.hpp"
#include "umform/elements/topology.hpp"
#include "umform/surfaces/concept.hpp"

namespace umform {

/// Where a facet is checked: at points x points Gauss points, or at its nodes with tributary areas.
struct ContactRule {
    int points = 2;
    bool at_nodes = false;
};

/// Rigid position of a tool: a point X of the tool's own frame lies at x = Q X + c.
struct Pose {
    Mat3 Q{{1, 0, 0, 0, 1, 0, 0, 0, 1}};
    Vec3 c{};
};

class ContactBlock {
  public:
    virtual ~ContactBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    /// Moves the contact points to x = X + u and asks the tool for gap, normal and Hessian there.
    virtual void locate(const double* u) = 0;

    Pose pose;
    double penalty = 0.0;

    int points() const { return static_cast<int>(g_.size()); }
    /// Shape functions at the contact points of a facet, [point][node].
    virtual std::vector<double> shape_values() const = 0;
    const std::vector<double>& positions() const { return x_; }
    const std::vector<double>& gaps() const { return g_; }
    const std::vector<double>& normals() const { return n_; }
    const std::vector<double>& areas() const { return area_; }
    /// Square of what a relative error of all positions makes of the residual, over the square of that error, at the last
    /// `evaluate`. eq. (5.36)
    virtual double round_off_squared() const = 0;
    /// Pressures at the contact points that are there without a penetration, zero or more.
    const std::vector<double>& multipliers() const { return multiplier_; }
    void set_multipliers(const double* values) { multiplier_.assign(values, values + multiplier_.size()); }

  protected:
    /// Gap less multiplier over penalty: a point is held where it is not positive, with -penalty times it. eq. (4.33)
    double shifted_gap(int q) const { return g_[q] - multiplier_[q] / penalty; }

    /// Length of the largest number that the gap of point q is a difference of: the position in space, that of the tool,
    /// or the distance from the centre of curvature, 1/|H|. eq. (5.35)
    double largest_length(int q) const {
        const double *x = x_.data() + 3 * q, *H = H_.data() + 9 * q;
        const double place = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) + std::sqrt(dot(pose.c, pose.c));
        double curvature = 0.0;
        for (int i = 0; i < 9; ++i) curvature += H[i] * H[i];
        curvature = std::sqrt(curvature);
        return curvature * flattest * place > 1.0 ? place + 1.0 / curvature : place;
    }

    /// Radii above so many times the place of a point are those of a plane, whose H may be noise.
    static constexpr double flattest = 1e3;

    std::vector<double> x_, g_, n_, H_;  // at the contact points of the last `locate`
    std::vector<double> area_;           // [facet][point] reference area of a contact point
    std::vector<double> multiplier_;     // [facet][point]
};

template <int Nodes>
class ContactBlockOf final : public ContactBlock {
  public:
    static constexpr int size = 3 * Nodes;

    ContactBlockOf(Connectivity part, std::vector<double> X, ContactRule rule, std::shared_ptr<const Surface> surface)
        : part_(std::move(part)), X_(std::move(X)), surface_(std::move(surface)), colours_(make_colours(part_)) {
        if (rule.at_nodes)
            nodal_rule();
        else
            gauss_rule(gauss(rule.points));
        const std::size_t count = part_.size() * N_.size();
        x_.resize(3 * count), g_.resize(count), n_.resize(3 * count), H_.resize(9 * count);
        multiplier_.assign(count, 0.0);
        scale_.resize(part_.size());
    }

    const Connectivity& connectivity() const override { return part_; }
    std::size_t dofs() const override { return X_.size(); }

    std::vector<double> shape_values() const override {
        std::vector<double> values;
        for (const Values& N : N_) values.insert(values.end(), N.begin(), N.end());
        return values;
    }

    void locate(const double* u) override {
        const int per_facet = static_cast<int>(N_.size());
        for (int e = 0; e < part_.size(); ++e)
            for (int q = 0; q < per_facet; ++q) {
                Vec3 x{};
                for (int a = 0; a < Nodes; ++a)
                    for (int k = 0; k < 3; ++k) x[k] += N_[q][a] * (X_[3 * part_[e][a] + k] + u[3 * part_[e][a] + k]);
                for (int k = 0; k < 3; ++k) {  // into the frame of the tool: Q^T (x - c)
                    double value = 0.0;
                    for (int m = 0; m < 3; ++m) value += pose.Q(m, k) * (x[m] - pose.c[m]);
                    x_[3 * (e * per_facet + q) + k] = value;
                }
            }
        surface_->gap(points(), x_.data(), g_.data(), n_.data(), H_.data());
        for (int q = 0; q < points(); ++q) to_space(q);
    }

    double round_off_squared() const override {
        const int per_facet = static_cast<int>(N_.size());
        double sum = 0.0;
        for (int e = 0; e < part_.size(); ++e) {
            Values force{};  // the points of a facet share its nodes: their errors may all point one way
            for (int q = 0; q < per_facet; ++q) {
                const int point = e * per_facet + q;
                if (shifted_gap(point) > 0.0) continue;
                const double weight = penalty * area_[point] * largest_length(point);
                for (int a = 0; a < Nodes; ++a) force[a] += weight * std::abs(N_[q][a]);
            }
            for (const double value : force) sum += value * value;
        }
        return sum;
    }

    /// f_a = penalty int g~ n N_a,  K_ab = penalty int N_a N_b (n n^T + g~ H) over the points whose shifted gap g~ is not
    /// positive (a tool that just touches can hold). eqs. (4.9), (4.10), (4.33)
    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        locate(u);
        const int per_facet = static_cast<int>(N_.size());
        for_each_by_colour(colours_, part_.size(), thread_count(), [&](int e, int) {
            scale_[e] = 0.0;
            bool active = false;
            for (int q = 0; q < per_facet; ++q) active = active || shifted_gap(e * per_facet + q) <= 0.0;
            if (!active) return;
            alignas(64) std::array<double, static_cast<std::size_t>(size) * size> K{};
            std::array<double, size> f{};
            for (int q = 0; q < per_facet; ++q)
                add_point(e * per_facet + q, N_[q], target.wants_tangent(), K.data(), f.data());
            for (const double value : f) scale_[e] += value * value;
            scatter_element<Nodes>(part_, scatter, e, K.data(), f.data(), target);
        });
        Outcome outcome;
        for (const double scale : scale_) outcome.force_scale_squared += scale;
        return outcome;
    }

  private:
    using Values = std::array<double, Nodes>;

    void gauss_rule(const Rule& rule) {
        for (int is = 0; is < rule.size(); ++is)
            for (int ir = 0; ir < rule.size(); ++ir) N_.push_back(face_shape<Nodes>(rule.x[ir], rule.x[is]).N);
        for (int e = 0; e < part_.size(); ++e)
            for (int is = 0; is < rule.size(); ++is)
                for (int ir = 0; ir < rule.size(); ++ir)
                    area_.push_back(rule.w[ir] * rule.w[is] * jacobian(e, rule.x[ir], rule.x[is]));
    }

    /// Tributary areas int N_a dA: 1/4 of a plane 4-node facet, 1/36, 4/36 and 16/36 of a plane 9-node facet. eq. (4.12)
    void nodal_rule() {
        for (int a = 0; a < Nodes; ++a) {
            Values N{};
            N[a] = 1.0;
            N_.push_back(N);
        }
        const Rule rule = gauss(4);
        for (int e = 0; e < part_.size(); ++e) {
            Values area{};
            for (int is = 0; is < rule.size(); ++is)
                for (int ir = 0; ir < rule.size(); ++ir) {
                    const double dA = rule.w[ir] * rule.w[is] * jacobian(e, rule.x[ir], rule.x[is]);
                    const Values N = face_shape<Nodes>(rule.x[ir], rule.x[is]).N;
                    for (int a = 0; a < Nodes; ++a) area[a] += N[a] * dA;
                }
            area_.insert(area_.end(), area.begin(), area.end());
        }
    }

    double jacobian(int e, double r, double s) const {
        const FaceShape<Nodes> shape = face_shape<Nodes>(r, s);
        Vec3 Gr{}, Gs{};
        for (int a = 0; a < Nodes; ++a)
            for (int k = 0; k < 3; ++k) {
                Gr[k] += shape.Nr[a] * X_[3 * part_[e][a] + k];
                Gs[k] += shape.Ns[a] * X_[3 * part_[e][a] + k];
            }
        const Vec3 normal = cross(Gr, Gs);
        return std::sqrt(dot(normal, normal));
    }

    /// Position, normal and Hessian of point q from the frame of the tool into space.
    void to_space(int q) {
        Vec3 x{x_[3 * q], x_[3 * q + 1], x_[3 * q + 2]}, n{n_[3 * q], n_[3 * q + 1], n_[3 * q + 2]};
        Mat3 H, QH;
        std::copy_n(H_.data() + 9 * q, 9, H.a.begin());
        const Mat3& Q = pose.Q;
        for (int i = 0; i < 3; ++i) {
            x_[3 * q + i] = Q(i, 0) * x[0] + Q(i, 1) * x[1] + Q(i, 2) * x[2] + pose.c[i];
            n_[3 * q + i] = Q(i, 0) * n[0] + Q(i, 1) * n[1] + Q(i, 2) * n[2];
            for (int j = 0; j < 3; ++j) QH(i, j) = Q(i, 0) * H(0, j) + Q(i, 1) * H(1, j) + Q(i, 2) * H(2, j);
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                H_[9 * q + 3 * i + j] = QH(i, 0) * Q(j, 0) + QH(i, 1) * Q(j, 1) + QH(i, 2) * Q(j, 2);
    }

    void add_point(int q, const Values& N, bool tangent, double* K, double* f) const {
        const double g = shifted_gap(q);
        if (g > 0.0) return;
        const double weight = penalty * area_[q];
        const double *n = n_.data() + 3 * q, *H = H_.data() + 9 * q;
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a) f[k * Nodes + a] += weight * g * n[k] * N[a];
        if (!tangent) return;
        for (int k = 0; k < 3; ++k)
            for (int l = k; l < 3; ++l) {
                const double stiffness = weight * (n[k] * n[l] + g * H[3 * k + l]);
                for (int a = 0; a < Nodes; ++a)
                    for (int b = 0; b < Nodes; ++b)
                        K[(k * Nodes + a) * size + l * Nodes + b] += stiffness * N[a] * N[b];
            }
    }

    Connectivity part_;
    std::vector<double> X_;
    std::shared_ptr<const Surface> surface_;
    std::vector<std::vector<std::int32_t>> colours_;
    std::vector<Values> N_;  // shape functions at the points of a facet
    std::vector<double> scale_;
};

}  // namespace umform
