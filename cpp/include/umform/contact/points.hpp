// The rule of points: the law is evaluated at Gauss points of a facet, or at its nodes; each point is held or not.
#pragma once

#include "umform/contact/facet.hpp"
#include "umform/contact/locator.hpp"
#include "umform/contact/rule.hpp"

namespace umform {

template <int Nodes>
class AtPoints : public FacetPoints<Nodes> {
  public:
    using Setting = ContactRule;
    using Values = std::array<double, Nodes>;
    static constexpr int size = 3 * Nodes;
    static constexpr bool symmetric = true, remembers = false;
    static constexpr VariableTable<0> table{};

    struct Workspace {
        explicit Workspace(std::size_t points) : reactions(points) {}
        std::vector<Reaction> reactions;
    };

    using FacetPoints<Nodes>::FacetPoints;

    void respond(const ContactLaw& law, const Locator<Nodes>& locator, int e, const HistoryRows& rows,
                 Workspace& work) const {
        law.respond(this->count(), locator.places(e), rows, work.reactions.data());
    }

    /// Of a symmetric law what is on and above the diagonal of K, and the diagonal blocks. eqs. (4.9), (4.10)
    void add(const ContactLaw& law, const Locator<Nodes>& locator, int e, int q, double area, const Workspace& work,
             bool tangent, double* K, double* f) const {
        const Values& N = locator.shapes(e)[q];
        const Reaction& reaction = work.reactions[q];
        const Vec3 force = reaction.force(locator.places(e).n[q], area);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a) f[k * Nodes + a] -= force[k] * N[a];
        if (!tangent) return;
        const bool symmetric = law.symmetric();
        for (int k = 0; k < 3; ++k)
            for (int l = symmetric ? k : 0; l < 3; ++l) {
                const double stiffness = area * reaction.K[k][l];
                for (int a = 0; a < Nodes; ++a)
                    for (int b = 0; b < Nodes; ++b)
                        K[(k * Nodes + a) * size + l * Nodes + b] += stiffness * N[a] * N[b];
            }
    }

    double gap(const ContactLaw&, const Locator<Nodes>& locator, int e, int q, const Workspace&, const double*) const {
        return locator.places(e).gap[q];
    }
    double penetration(const Locator<Nodes>& locator, int e, int q) const { return -locator.places(e).gap[q]; }
    double share(const Workspace&, int) const { return 1.0; }
    void leave(const double*, double*) const {}
    double contact_work(const double*) const { return 0.0; }
};

}  // namespace umform
