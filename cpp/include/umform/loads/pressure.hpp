// Follower pressure on element faces: its direction and area turn and stretch with the sheet.
#pragma once

#include "umform/assembly/target.hpp"
#include "umform/assembly/turns.hpp"
#include "umform/elements/kinematics.hpp"
#include "umform/elements/quadrature.hpp"
#include "umform/elements/topology.hpp"

namespace umform {

class PressureBlock {
  public:
    virtual ~PressureBlock() = default;
    virtual const Connectivity& connectivity() const = 0;
    virtual std::size_t dofs() const = 0;  // length of u and f
    virtual Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) = 0;
    double pressure = 0.0;  // against the outward normal of the face
    std::string name = "a follower pressure";
    static constexpr bool symmetric = false;
};

/// Facets are numbered so that x,r x x,s points out of the body. f_a = p int N_a (x,r x x,s) dr ds as an internal force;
/// its tangent is not symmetric. eqs. (5.3), (5.4)
template <int Nodes>
class PressureBlockOf final : public PressureBlock {
  public:
    static constexpr int size = 3 * Nodes;

    PressureBlockOf(Connectivity part, std::vector<double> X)
        : part_(std::move(part)), X_(std::move(X)), turns_(part_, make_colours(part_), facets_of_a_turn),
          scale_(part_.size()) {
        const Rule rule = gauss(Nodes == 4 ? 2 : 3);
        for (int is = 0; is < rule.size(); ++is)
            for (int ir = 0; ir < rule.size(); ++ir) {
                shapes_.push_back(face_shape<Nodes>(rule.x[ir], rule.x[is]));
                weights_.push_back(rule.w[ir] * rule.w[is]);
            }
    }

    const Connectivity& connectivity() const override { return part_; }
    std::size_t dofs() const override { return X_.size(); }

    Outcome evaluate(const double* u, const Scatter& scatter, const Target& target) override {
        if (target.values != nullptr) scatter.require(false, name);
        turns_.run(part_.size() < facets_worth_a_team ? 1 : thread_count().load(),
                   [&](int group, int, const auto& turn) {
                       for (const int e : turns_.elements(group)) facet(e, u, scatter, target, turn);
                   });
        Outcome outcome;
        for (const double scale : scale_) outcome.force_scale_squared += scale;
        return outcome;
    }

  private:
    template <class Turn>
    void facet(int e, const double* u, const Scatter& scatter, const Target& target, const Turn& turn) {
        std::array<double, size> X, x, f{};
        alignas(64) std::array<double, static_cast<std::size_t>(size) * size> K{};
        gather<Nodes>(part_, e, X_.data(), X.data());
        gather<Nodes>(part_, e, u, x.data());
        for (int i = 0; i < size; ++i) x[i] += X[i];
        for (std::size_t q = 0; q < shapes_.size(); ++q) {
            const FaceShape<Nodes>& shape = shapes_[q];
            const double p = pressure * weights_[q];
            const Vec3 gr = derivative<Nodes>(shape.Nr.data(), x.data()),
                       gs = derivative<Nodes>(shape.Ns.data(), x.data());
            const Vec3 normal = cross(gr, gs);
            for (int a = 0; a < Nodes; ++a)
                for (int k = 0; k < 3; ++k) {
                    f[k * Nodes + a] += p * shape.N[a] * normal[k];
                    if (!target.wants_tangent()) continue;
                    // d(gr x gs) = -gs x du,r + gr x du,s
                    for (int b = 0; b < Nodes; ++b)
                        for (int l = 0; l < 3; ++l) {
                            if (k == l) continue;
                            const int m = 3 - k - l;
                            const double sign = (l - k + 3) % 3 == 1 ? -1.0 : 1.0;  // (v x e_l)_k = sign v_m
                            K[(k * Nodes + a) * size + l * Nodes + b] +=
                                p * shape.N[a] * sign * (shape.Ns[b] * gr[m] - shape.Nr[b] * gs[m]);
                        }
                }
        }
        double sum = 0.0;
        for (const double value : f) sum += value * value;
        scale_[e] = sum;
        turn();
        scatter_element<Nodes>(part_, scatter, e, K.data(), f.data(), target, !symmetric);
    }

    Connectivity part_;
    std::vector<double> X_;
    Turns turns_;
    std::vector<double> scale_;
    std::vector<FaceShape<Nodes>> shapes_;
    std::vector<double> weights_;
};

}  // namespace umform
