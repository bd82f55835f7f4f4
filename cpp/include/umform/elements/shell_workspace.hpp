// Everything that one thread needs to work on the elements in the lanes; nothing is allocated after construction.
#pragma once

#include <vector>

#include "umform/elements/shell_tables.hpp"
#include "umform/elements/strain_rows.hpp"

namespace umform {

template <int Nodes, class Real>
struct ShellWorkspace {
    static constexpr int face = Nodes / 2, half = 3 * face, size = 2 * half;
    /// Values by degree of freedom: the mean by direction, mean[direction * face + node], then the director.
    using Nodal = std::array<Real, size>;

    /// `symmetric`: the tangent of the law is, and no room is needed for the other half of the blocks.
    ShellWorkspace(const ShellTables<Nodes>& tables, bool symmetric)
        : G(tables.places.size()), h(tables.places.size()), d(tables.places.size()), E(tables.points()),
          S(tables.points()), CC(tables.points()), A(tables.points()), dV(tables.points()), bent(tables.points()),
          enhanced(tables.points() * tables.enhanced.size()), mid_E(tables.mid_samples.size()),
          layer_E(tables.layer_samples.size()), mid_rows(tables.mid_samples.size() * size),
          layer_rows(tables.layer_samples.size() * 2 * size), mean_rows(8 * half), director_rows(14 * half),
          product(director_rows), mode_moments(tables.modes), dual_moments(symmetric ? 0 : tables.modes),
          moments(tables.places.size()), Kmm(half * half), Kdm(Kmm), Kdd(Kmm), Kmd(symmetric ? 0 : half * half),
          Kaa(tables.group_entries()), Kad(tables.modes * size), Kda(Kad), ra(tables.modes) {}

    /// Sets to zero what `SolidShell::integrate` adds to, with or without a tangent.
    void clear(bool tangent) {
        f.fill(0.0);
        for (std::vector<Real>* sum : {&Kaa, &Kad, &ra}) std::fill(sum->begin(), sum->end(), Real(0.0));
        if (!Kmd.empty()) std::fill(Kda.begin(), Kda.end(), Real(0.0));  // else it is a copy of Kad
        if (!tangent) return;
        geometry_mm.fill(0.0), geometry_dm.fill(0.0), geometry_dd.fill(0.0);
        for (std::vector<Real>* sum : {&Kmm, &Kdm, &Kdd, &Kmd}) std::fill(sum->begin(), sum->end(), Real(0.0));
        for (auto& of_place : moments)
            for (auto& of_component : of_place) of_component.fill(0.0);
    }

    /// The same for the moments of a column.
    void clear_column(bool tangent) {
        stress = {};
        if (tangent) foreseen = {}, C = {};
    }

    // Strain and material.
    std::vector<Base<Real>> G, h, d;     // [place] reference base vectors, gradients of displacement and correction
    std::vector<Vec<Real, 6>> E, S;      // [q] in the local frame
    std::vector<Mat<Real, 6, 6>> CC;     // [q]
    std::vector<Mat<Real, 3, 3>> A;      // [q] J^-1 in the local frame
    std::vector<Real> dV;                // [q]
    std::vector<Vec<Real, 6>> bent;      // [q] covariant strain that is quadratic in the correction
    std::vector<Vec<Real, 6>> enhanced;  // [q][component] covariant direction of an enhanced component
    std::vector<Real> mid_E;             // [sample]
    std::vector<std::array<Real, 3>> layer_E;  // [sample][power of t]
    // Rows and their products.
    std::vector<Real> mid_rows, layer_rows;               // [sample][size], [sample][power of t][size]
    std::vector<Real> mean_rows, director_rows, product;  // of a column: [rows_of_mean or rows_of_director][half]
    // Of a column: moments in t of the stress, of that of the geometric stiffness, of the tangent, of what the modes take from
    // the rows of the tangent, and from its columns.
    std::array<Vec<Real, 6>, 3> stress, foreseen;
    std::array<std::array<Vec<Real, 6>, 6>, 5> C;
    std::vector<std::array<Vec<Real, 6>, 3>> mode_moments, dual_moments;  // [mode]
    std::vector<std::array<std::array<Real, 3>, 6>> moments;  // [place][component][power of t] of the stress
    bool rolled = false;                                      // the frame follows a rolling direction, and A is full
    // Results: the blocks mean-mean, director-mean, director-director of K; of the first and last what is on and above the
    // diagonal. Of a law whose tangent is not symmetric all of them, and the block mean-director.
    std::vector<Real> Kmm, Kdm, Kdd, Kmd;
    std::array<Real, static_cast<std::size_t>(face) * face> geometry_mm, geometry_dm, geometry_dd;  // [node][node]
    Nodal f;
    // Enhanced parameters: Kaa holds the blocks of the groups of modes behind each other. After `condense`, Kad holds Kaa^-1 Kad
    // and ra holds Kaa^-1 ra. Kda is stored as its transpose.
    std::vector<Real> Kaa, Kad, Kda, ra;
};

}  // namespace umform
