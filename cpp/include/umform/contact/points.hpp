// The rule of points: the law is asked at Gauss points of a facet, or at its nodes, and each of them is held or not.
#pragma once

#include "umform/contact/facet.hpp"
#include "umform/contact/locator.hpp"
#include "umform/contact/rule.hpp"

namespace umform {

template <int Nodes>
class AtPoints : public FacetPoints<Nodes> {
  public:
    using Setting = ContactRule;
    static constexpr bool symmetric = true, remembers = false;
    static std::vector<Quantity> quantities() { return {}; }

    struct Workspace {
        explicit Workspace(std::size_t points) : reactions(points) {}
        std::vector<Reaction> reactions;
    };

    using FacetPoints<Nodes>::FacetPoints;

    double reach(const Locator<Nodes>&, int) const { return 0.0; }
    void respond(const ContactLaw& law, const Locator<Nodes>& locator, int e, const double* weights,
                 const HistoryRows& rows, Workspace& work) const {
        law.respond(this->count(), locator.places(e), weights, rows, work.reactions.data());
    }
    static constexpr const Spread<Nodes>* spread(const Workspace&, int) { return nullptr; }

    double gap(const ContactLaw&, const Locator<Nodes>& locator, int e, int q, const Workspace&, const double*) const {
        return locator.places(e).gap[q];
    }
    double penetration(const Locator<Nodes>& locator, int e, int q) const { return -locator.places(e).gap[q]; }
    double share(const Workspace&, int) const { return 1.0; }
    void leave(const double*, double*) const {}
    double contact_work(const double*) const { return 0.0; }
};

}  // namespace umform
