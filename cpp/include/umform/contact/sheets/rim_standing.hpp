// A place of a face with its foot on a cut edge: the forces at both, and their derivatives.
#pragma once

#include "umform/contact/sheets/other_face.hpp"

namespace umform {

template <int Nodes>
struct RimStanding {
    using Values = std::array<double, Nodes>;
    using Derivatives = typename Rim<Nodes>::Derivatives;
    static constexpr int blocks = Derivatives::blocks;

    const FacetFoot& foot;
    const Values& N;  // of the place on its own facet
    Slot slot;
    Derivatives of_gap;

    RimStanding(const FacetFoot& foot, const Values& N, const Vec3& x, const OtherFace<Nodes>& face, LoosePart& part,
                std::vector<Slot>& met)
        : foot(foot), N(N), slot(face.slot(part, met, foot)), of_gap(face.rims().at(foot.rim).derivatives(x, foot.r)) {}

    /// Adds a factor times the change of the gap to a row.
    void add_gap(double factor, double* row) const {
        each([&](int block, int, int column, double by) {
            for (int l = 0; l < 3; ++l) row[3 * column + l] += factor * by * of_gap.first[3 * block + l];
        });
    }

    /// Adds the forces of a pressure times a weight, and their derivatives; slope: of the pressure. eqs. (4.332), (4.333)
    void add_pressure(double weight, double pressure, const double* slope, bool tangent, LoosePart& part) const {
        each([&](int block, int node, int, double by) {
            for (int i = 0; i < 3; ++i) {
                const double force = weight * by * of_gap.first[3 * block + i];
                part.f[3 * node + i] -= force * pressure;
                if (!tangent) continue;
                double* row = part.row(3 * node + i);
                for (int j = 0; j < part.columns(); ++j) row[j] -= force * slope[j];
                const double* second = of_gap.second.data() + (3 * block + i) * Derivatives::size;
                each([&](int other, int, int column, double more) {
                    for (int l = 0; l < 3; ++l)
                        row[3 * column + l] -= weight * pressure * by * more * second[3 * other + l];
                });
            }
        });
    }

  private:
    /// Calls visit(block, node of the forces, node of the derivatives, share of the node in the block).
    template <class Visit>
    void each(const Visit& visit) const {
        for (int a = 0; a < Nodes; ++a) visit(0, a, a, N[a]);
        for (int block = 1; block < blocks; ++block) visit(block, slot.row + block - 1, slot.column + block - 1, 1.0);
    }
};

}  // namespace umform
