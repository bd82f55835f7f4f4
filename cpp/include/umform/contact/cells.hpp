// The rule of cells: a gap that is linear over each of n x n cells of a facet is integrated where it is negative.
#pragma once

#include "umform/contact/locator.hpp"
#include "umform/contact/overlap.hpp"
#include "umform/contact/own_overlap.hpp"
#include "umform/contact/rule.hpp"

namespace umform {

/// Cells per direction of a facet.
struct CellSetting {
    int cells = 3;
};

/// Places of the cells of a facet: their mean places, and after these their corners, row by row. The mean of the shape functions is
/// taken over the reference area, so that a uniform pressure gives its consistent nodal forces on any facet. eq. (4.81)
template <int Nodes>
struct FacetCells {
    using Values = std::array<double, Nodes>;
    static constexpr int corners = 4;

    std::vector<Values> N;     // [facet][place]
    std::vector<double> area;  // [facet][cell]

    FacetCells(const Connectivity& part, const std::vector<double>& X, CellSetting setting) : per_side_(setting.cells) {
        for (int e = 0; e < part.size(); ++e) {
            for (int j = 0; j < per_side_; ++j)
                for (int i = 0; i < per_side_; ++i) add_mean(part[e], X, i, j);
            for (int j = 0; j <= per_side_; ++j)
                for (int i = 0; i <= per_side_; ++i) N.push_back(face_shape<Nodes>(at(i, -1.0), at(j, -1.0)).N);
        }
    }

    int count() const { return per_side_ * per_side_; }
    int places() const { return count() + (per_side_ + 1) * (per_side_ + 1); }
    /// The corners of a cell, in the order of `Cut`.
    std::array<int, corners> corners_of(int cell) const {
        const int first = count() + cell / per_side_ * (per_side_ + 1) + cell % per_side_;
        return {first, first + 1, first + per_side_ + 2, first + per_side_ + 1};
    }
    double largest_motion() const { return umform::largest_motion<Nodes>(N); }

  private:
    double side() const { return 2.0 / per_side_; }
    double at(int cell, double x) const { return -1.0 + side() * (cell + 0.5 * (1.0 + x)); }

    void add_mean(const std::int32_t* ids, const std::vector<double>& X, int i, int j) {
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
    static constexpr int size = 3 * Nodes;
    static constexpr bool symmetric = false, remembers = true;
    static constexpr VariableTable table{{{"gap of the cell"}, {"pressure"}, {"contact energy"}, {"contact work"}}};

    struct Workspace {
        explicit Workspace(std::size_t cells)
            : reactions(cells), gap(cells), share(cells), pressures(cells), energies(cells), slopes(cells) {}
        std::vector<Reaction> reactions;
        std::vector<double> gap, share;             // the gap that is left, the part of the area that is held
        std::vector<double> pressures, energies;    // means over the cell
        std::vector<std::array<double, 4>> slopes;  // minus the derivatives of the pressure by the gaps at the corners
    };

    using FacetCells<Nodes>::FacetCells;

    void respond(const ContactLaw& law, const Locator<Nodes>& locator, int e, const HistoryRows& rows,
                 Workspace& work) const {
        const Places places = locator.places(e);
        if (const GivenPressure given = law.given_pressure(); given.law != nullptr)
            press_by(given, places, work);
        else
            press_by_penalty(law.penalty(), places, rows, work);
        for (int q = 0; q < this->count(); ++q) work.reactions[q].held = work.share[q] > 0.0;
        law.press(this->count(), places, work.pressures.data(), rows, work.reactions.data());
        for (int q = 0; q < this->count(); ++q)
            remember(places.gap[q], q, work, rows.state + q * rows.size + rows.of_law,
                     rows.trial + q * rows.size + rows.of_law);
    }

    /// f_a and K_ab of a cell: -dt has the part penalty (dt/dp) (x) dP0. eqs. (4.86), (4.87)
    void add(const ContactLaw&, const Locator<Nodes>& locator, int e, int q, double area, const Workspace& work,
             bool tangent, double* K, double* f) const {
        const Places places = locator.places(e);
        const Reaction& reaction = work.reactions[q];
        const Values& N = locator.shapes(e)[q];
        const Vec3 force = reaction.force(places.n[q], area);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a) f[k * Nodes + a] -= force[k] * N[a];
        if (!tangent) return;
        std::array<double, size> slope{};  // area dP0/du
        const auto corners = this->corners_of(q);
        for (int i = 0; i < this->corners; ++i) {
            const Values& there = locator.shapes(e)[corners[i]];
            for (int l = 0; l < 3; ++l) {
                const double by_place = area * work.slopes[q][i] * places.n[corners[i]][l];
                for (int b = 0; b < Nodes; ++b) slope[l * Nodes + b] += by_place * there[b];
            }
        }
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
                for (int a = 0; a < Nodes; ++a)
                    for (int b = 0; b < Nodes; ++b)
                        K[(k * Nodes + a) * size + l * Nodes + b] +=
                            N[a] * (reaction.by_pressure[k] * slope[l * Nodes + b] + area * reaction.K[k][l] * N[b]);
    }

    /// The gap that is left: that of a point with the same pressure and the same multiplier. eq. (4.90)
    double gap(const ContactLaw& law, const Locator<Nodes>&, int, int q, const Workspace& work,
               const double* row) const {
        return work.gap[q] + row[ContactHistory::Multiplier] / law.penalty();
    }
    /// The mean over the cell, zero where it is outside of the tool.
    double penetration(const Locator<Nodes>& locator, int e, int q) const {
        return -Cut(corner_gaps(locator.places(e), q)).overlap.gap;
    }
    double share(const Workspace& work, int q) const { return work.share[q]; }

    /// The tool has left the cell: what was stored comes back.
    void leave(const double* state, double* trial) const {
        trial[Gap] = trial[Pressure] = trial[Energy] = 0.0;
        trial[Work] = state[Work] - state[Energy];
    }
    double contact_work(const double* row) const { return row[Work]; }

  private:
    enum {
        Gap = table["gap of the cell"],
        Pressure = table["pressure"],
        Energy = table["contact energy"],
        Work = table["contact work"]
    };

    std::array<double, 4> corner_gaps(const Places& places, int q) const {
        std::array<double, 4> G;
        const auto corners = this->corners_of(q);
        for (int i = 0; i < this->corners; ++i) G[i] = places.gap[corners[i]];
        return G;
    }

    void press_by_penalty(double penalty, const Places& places, const HistoryRows& rows, Workspace& work) const {
        for (int q = 0; q < this->count(); ++q) {
            const double shift = rows.trial[q * rows.size + ContactHistory::Multiplier] / penalty;
            std::array<double, 4> G = corner_gaps(places, q);
            for (double& value : G) value -= shift;
            const Overlap overlap = Cut(G).overlap;
            work.gap[q] = overlap.gap, work.share[q] = overlap.share;
            work.pressures[q] = -penalty * overlap.gap, work.energies[q] = penalty * overlap.half_square;
            for (int i = 0; i < this->corners; ++i) work.slopes[q][i] = penalty * overlap.by_corner[i];
        }
    }

    /// All cells by one call of the law of a user. eqs. (4.283), (4.284)
    void press_by(const GivenPressure& given, const Places& places, Workspace& work) const {
        std::vector<std::array<double, 4>> G;
        for (int q = 0; q < this->count(); ++q) G.push_back(corner_gaps(places, q));
        const OwnCuts cuts(*given.law, given.scale, G);
        for (int q = 0; q < this->count(); ++q) {
            const OwnOverlap& overlap = cuts.overlaps[q];
            work.gap[q] = overlap.share > 0.0 ? overlap.gap / overlap.share : 0.0, work.share[q] = overlap.share;
            work.pressures[q] = overlap.pressure, work.energies[q] = overlap.energy;
            work.slopes[q] = overlap.by_corner;
        }
    }

    /// The work of the mean pressure on the gap of the mean place; a first touch and the end of contact take the energy that a
    /// cell of the same slope has. eq. (4.89)
    static void remember(double gap, int q, const Workspace& found, const double* state, double* trial) {
        const bool before = state[Pressure] > 0.0, now = found.share[q] > 0.0;
        trial[Gap] = now ? gap : 0.0;
        trial[Pressure] = now ? found.pressures[q] : 0.0;
        trial[Energy] = now ? found.energies[q] : 0.0;
        double work = trial[Energy] - state[Energy];
        if (before && now) work = -0.5 * (state[Pressure] + trial[Pressure]) * (gap - state[Gap]);
        trial[Work] = state[Work] + work;
    }
};

}  // namespace umform
