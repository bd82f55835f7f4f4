// The rule of cells: a gap that is linear over each of n x n cells of a facet is integrated where it is negative.
#pragma once

#include "umform/contact/locator.hpp"
#include "umform/contact/overlap.hpp"
#include "umform/contact/rule.hpp"

namespace umform {

/// Cells per direction of a facet.
struct CellSetting {
    int cells = 3;
};

/// Means over the cells of a facet. Those of the shape functions are taken over the reference area, so that a uniform pressure
/// gives its consistent nodal forces on any facet. eq. (4.81)
template <int Nodes>
struct FacetCells {
    using Values = std::array<double, Nodes>;

    std::vector<Values> N;         // [facet][cell]
    std::vector<double> area;      // [facet][cell]
    std::vector<Values> t_r, t_s;  // [cell] sides of a cell from nodes: h N,r and h N,s, means over (r, s)

    FacetCells(const Connectivity& part, const std::vector<double>& X, CellSetting setting) : per_side_(setting.cells) {
        for (int j = 0; j < per_side_; ++j)
            for (int i = 0; i < per_side_; ++i) add_sides(i, j);
        for (int e = 0; e < part.size(); ++e)
            for (int j = 0; j < per_side_; ++j)
                for (int i = 0; i < per_side_; ++i) add_means(part[e], X, i, j);
    }

    int count() const { return per_side_ * per_side_; }
    /// How far a mean place can move at most when no node moves farther than by one.
    double largest_motion() const { return std::max(1.0, largest_sum(N)); }
    /// How long half the sides of a cell are at most, together, when no node is farther than one from some point.
    double largest_extent() const { return 0.5 * (largest_sum(t_r) + largest_sum(t_s)); }

  private:
    double side() const { return 2.0 / per_side_; }
    double at(int cell, double x) const { return -1.0 + side() * (cell + 0.5 * (1.0 + x)); }

    void add_sides(int i, int j) {
        Values mean_r{}, mean_s{};
        for (int iy = 0; iy < rule_.size(); ++iy)
            for (int ix = 0; ix < rule_.size(); ++ix) {
                const FaceShape<Nodes> shape = face_shape<Nodes>(at(i, rule_.x[ix]), at(j, rule_.x[iy]));
                const double weight = 0.25 * side() * rule_.w[ix] * rule_.w[iy];
                for (int a = 0; a < Nodes; ++a) mean_r[a] += weight * shape.Nr[a], mean_s[a] += weight * shape.Ns[a];
            }
        t_r.push_back(mean_r), t_s.push_back(mean_s);
    }

    void add_means(const std::int32_t* ids, const std::vector<double>& X, int i, int j) {
        Values mean{};
        double whole = 0.0;
        for (int iy = 0; iy < rule_.size(); ++iy)
            for (int ix = 0; ix < rule_.size(); ++ix) {
                const double r = at(i, rule_.x[ix]), s = at(j, rule_.x[iy]);
                const Values values = face_shape<Nodes>(r, s).N;
                const double dA =
                    0.25 * side() * side() * rule_.w[ix] * rule_.w[iy] * face_jacobian<Nodes>(ids, X, r, s);
                for (int a = 0; a < Nodes; ++a) mean[a] += values[a] * dA;
                whole += dA;
            }
        for (double& value : mean) value /= whole;
        N.push_back(mean), area.push_back(whole);
    }

    static double largest_sum(const std::vector<Values>& all) {
        double largest = 0.0;
        for (const Values& values : all) {
            double sum = 0.0;
            for (const double value : values) sum += std::abs(value);
            largest = std::max(largest, sum);
        }
        return largest;
    }

    int per_side_;
    Rule rule_ = gauss(4);
};

/// The pressure of a cell is the mean of <multiplier - penalty G> over it; the law says at the mean place what follows from it.
/// There is no potential: the work of the pressure is summed along the way. eqs. (4.81), (4.82), (4.83), (4.87), (4.89)
template <int Nodes>
class OverCells : public FacetCells<Nodes> {
  public:
    using Setting = CellSetting;
    using Values = std::array<double, Nodes>;
    static constexpr bool symmetric = false, remembers = true;
    static std::vector<Quantity> quantities() {
        return {{"begun", 1}, {"gap of the cell", 1}, {"pressure", 1}, {"contact energy", 1}, {"contact work", 1}};
    }

    struct Workspace {
        explicit Workspace(std::size_t cells) : reactions(cells), overlaps(cells), spreads(cells), pressures(cells) {}
        std::vector<Reaction> reactions;
        std::vector<Overlap> overlaps;
        std::vector<Spread<Nodes>> spreads;
        std::vector<double> pressures;
    };

    using FacetCells<Nodes>::FacetCells;

    /// A corner of a cell touches before its mean place does.
    double reach(const Locator<Nodes>& locator, int e) const { return extent_ * locator.extent(e); }

    void respond(const ContactLaw& law, const Locator<Nodes>& locator, int e, const double* weights,
                 const HistoryRows& rows, Workspace& work) const {
        const Places places = locator.places(e);
        const double penalty = law.penalty();
        for (int q = 0; q < this->count(); ++q) {
            const Sides sides(*this, locator, e, q);
            work.overlaps[q] = sides.overlap(places.gap[q] - rows.trial[q * rows.size] / penalty, places.n[q]);
            work.reactions[q].held = work.overlaps[q].share > 0.0;
            work.pressures[q] = -penalty * work.overlaps[q].gap;
        }
        law.press(this->count(), places, work.pressures.data(), weights, rows, work.reactions.data());
        for (int q = 0; q < this->count(); ++q) {
            if (work.reactions[q].held) differentiate(penalty, locator, e, q, work);
            remember(penalty, places.gap[q], work.overlaps[q], rows.state + q * rows.size + rows.of_law,
                     rows.trial + q * rows.size + rows.of_law);
        }
    }

    const Spread<Nodes>* spread(const Workspace& work, int q) const { return &work.spreads[q]; }

    /// The gap that is left: that of a point with the same pressure and the same multiplier. eq. (4.90)
    double gap(const ContactLaw& law, const Locator<Nodes>&, int, int q, const Workspace& work,
               const double* row) const {
        return work.overlaps[q].gap + row[0] / law.penalty();
    }
    /// The mean over the cell, zero where it is outside of the tool.
    double penetration(const Locator<Nodes>& locator, int e, int q) const {
        const Places places = locator.places(e);
        return -Sides(*this, locator, e, q).overlap(places.gap[q], places.n[q]).gap;
    }
    double share(const Workspace& work, int q) const { return work.overlaps[q].share; }

    /// The tool has left the cell: what was stored comes back.
    void leave(const double* state, double* trial) const {
        trial[Begun] = 1.0;
        trial[Gap] = trial[Pressure] = trial[Energy] = 0.0;
        trial[Work] = state[Work] - state[Energy];
    }
    double contact_work(const double* row) const { return row[Work]; }

  private:
    enum Part { Begun = 0, Gap = 1, Pressure = 2, Energy = 3, Work = 4 };

    /// Tangents of the face times the sides of a cell, now.
    struct Sides {
        Vec3 r{}, s{};
        Sides(const OverCells& rule, const Locator<Nodes>& locator, int e, int q) {
            for (int a = 0; a < Nodes; ++a) {
                const Vec3& y = locator.node(e, a);
                for (int k = 0; k < 3; ++k) r[k] += rule.t_r[q][a] * y[k], s[k] += rule.t_s[q][a] * y[k];
            }
        }
        Overlap overlap(double g, const Vec3& n) const { return Cut(g, dot(n, r), dot(n, s)).overlap; }
    };

    /// -dt of the pressure, penalty (dt/dp) (x) dP0 with dP0 = n . sum c_b du_b + (m10 H t_r + m01 H t_s) . dx. eqs. (4.85), (4.86)
    void differentiate(double penalty, const Locator<Nodes>& locator, int e, int q, Workspace& work) const {
        const Places places = locator.places(e);
        const Sides sides(*this, locator, e, q);
        const Overlap& overlap = work.overlaps[q];
        Reaction& reaction = work.reactions[q];
        Spread<Nodes>& spread = work.spreads[q];
        Vec3 along;
        for (int k = 0; k < 3; ++k) along[k] = overlap.m_xi * sides.r[k] + overlap.m_eta * sides.s[k];
        const Vec3 turned = product(places.H[q], along);
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l) {
                spread.S(k, l) = penalty * reaction.by_pressure[k] * places.n[q][l];
                reaction.K[k][l] += penalty * reaction.by_pressure[k] * turned[l];
            }
        const Values& N = locator.shapes(e)[q];
        for (int a = 0; a < Nodes; ++a)
            spread.c[a] = overlap.share * N[a] + overlap.m_xi * this->t_r[q][a] + overlap.m_eta * this->t_s[q][a];
    }

    /// The work of the mean pressure on the gap of the mean place; a first touch and the end of contact take the energy that a
    /// cell of the same slope has. eq. (4.89). Nothing is counted before the first converged state: cells beside a place where a
    /// tool just touches overlap it then, which the first increment gives back.
    static void remember(double penalty, double gap, const Overlap& overlap, const double* state, double* trial) {
        const bool before = state[Pressure] > 0.0, now = overlap.share > 0.0 && state[Begun] != 0.0;
        trial[Begun] = 1.0;
        trial[Gap] = now ? gap : 0.0;
        trial[Pressure] = now ? -penalty * overlap.gap : 0.0;
        trial[Energy] = now ? penalty * overlap.half_square : 0.0;
        double work = trial[Energy] - state[Energy];
        if (before && now) work = -0.5 * (state[Pressure] + trial[Pressure]) * (gap - state[Gap]);
        trial[Work] = state[Work] + work;
    }

    double extent_ = this->largest_extent();
};

}  // namespace umform
