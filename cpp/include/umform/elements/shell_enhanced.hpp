// The enhanced parameters of an element: their blocks of the tangent, and their elimination.
#pragma once

#include "umform/elements/shell_products.hpp"

namespace umform {

template <int Nodes, class Real>
class ShellEnhanced : public ShellProducts<Nodes, Real> {
    using Products = ShellProducts<Nodes, Real>;

  public:
    using Products::Products, Products::half, Products::size;
    using typename Products::Workspace;

    /// Eliminates the enhanced parameters: K -= Kda Kaa^-1 Kad, f -= Kda Kaa^-1 ra. False where Kaa is singular.
    /// eq. (2.18) Without a tangent K and Kad are unchanged.
    Mask<Real> condense(bool tangent, Workspace& w) const {
        if (tables_.modes == 0) return true;
        const Mask<Real> regular = symmetric_ ? eliminate(w) : eliminate_full(w);
        for (int m = 0; m < tables_.modes; ++m)
            for (int i = 0; i < size; ++i) w.f[i] -= w.Kda[m * size + i] * w.ra[m];
        if (tangent) symmetric_ ? condense_tangent(w) : condense_tangent_full(w);
        return regular;
    }

  protected:
    using Products::symmetric_;
    using Products::tables_;
    using typename Products::Moments, typename Products::Voigt, typename Products::Voigt66;
    /// Powers of the height of a point.
    using Powers = std::array<double, 5>;

    /// Kaa (lower triangles) and ra, and the moments of Kad over the column. eqs. (2.15), (2.16)
    void add_enhanced_blocks(int q, const Powers& t, const Voigt& S, const Voigt66& C, Workspace& w) const {
        const int count = static_cast<int>(tables_.enhanced.size());
        const Voigt* direction = w.enhanced.data() + q * count;
        const auto& [first, modes, offset] = tables_.groups[tables_.group_of[q]];
        Real* Kaa = w.Kaa.data() + offset;
        for (int c = 0; c < count; ++c) {
            Voigt Cd;
            for (int p = 0; p < 6; ++p) Cd[p] = dot(direction[c], C[p]);
            std::array<Real, 6> dCd;
            for (int other = 0; other < count; ++other) dCd[other] = dot(direction[other], Cd);
            const Real dS = dot(direction[c], S);
            for (const auto& [component, mode, value] : tables_.entries[q]) {
                if (component != c) continue;
                w.ra[mode] += value * dS;
                add_moments(value, t, Cd, w.mode_moments[mode]);
                for (const auto& other : tables_.entries[q])
                    if (other.mode <= mode)
                        Kaa[(mode - first) * modes + other.mode - first] += value * other.value * dCd[other.component];
            }
        }
    }

    /// The same with Kda (as its transpose) and all of Kaa, for a law whose tangent is not symmetric.
    void add_enhanced_blocks_full(int q, const Powers& t, const Voigt& S, const Voigt66& C, Workspace& w) const {
        const int count = static_cast<int>(tables_.enhanced.size());
        const Voigt* direction = w.enhanced.data() + q * count;
        const auto& [first, modes, offset] = tables_.groups[tables_.group_of[q]];
        Real* Kaa = w.Kaa.data() + offset;
        for (int c = 0; c < count; ++c) {
            Voigt Cd, dC{};
            for (int p = 0; p < 6; ++p) {
                Cd[p] = dot(direction[c], C[p]);
                for (int r = 0; r < 6; ++r) dC[p] += direction[c][r] * C[r][p];
            }
            const Real dS = dot(direction[c], S);
            for (const auto& [component, mode, value] : tables_.entries[q]) {
                if (component != c) continue;
                w.ra[mode] += value * dS;
                add_moments(value, t, dC, w.mode_moments[mode]);
                add_moments(value, t, Cd, w.dual_moments[mode]);
                for (const auto& other : tables_.entries[q])
                    Kaa[(mode - first) * modes + other.mode - first] +=
                        value * other.value * dot(dC, direction[other.component]);
            }
        }
    }

    /// Kad, and Kda of a law whose tangent is not symmetric, of the modes of a column from their moments.
    template <int First>
    void add_coupling(int point, Workspace& w) const {
        for (const int mode : tables_.modes_of[point]) {
            Products::template add_force<First>(w.mode_moments[mode], w, w.Kad.data() + mode * size);
            w.mode_moments[mode] = {};
            if (symmetric_) continue;
            Products::template add_force<First>(w.dual_moments[mode], w, w.Kda.data() + mode * size);
            w.dual_moments[mode] = {};
        }
    }

    static void add_moments(double value, const Powers& t, const Voigt& of, Moments& sum) {
        for (int k = 0; k < 3; ++k)
            for (int p = 0; p < 6; ++p) sum[k][p] += value * t[k] * of[p];
    }

  private:
    Mask<Real> eliminate(Workspace& w) const {
        Mask<Real> regular = true;
        w.Kda = w.Kad;
        for (const auto& [first, modes, offset] : tables_.groups) {
            regular = regular & factor_ldlt(w.Kaa.data() + offset, modes);
            solve_ldlt(w.Kaa.data() + offset, modes, w.ra.data() + first, 1);
        }
        return regular;
    }
    Mask<Real> eliminate_full(Workspace& w) const {
        Mask<Real> regular = true;
        for (const auto& [first, modes, offset] : tables_.groups) {
            regular = regular & factor_lu(w.Kaa.data() + offset, modes);
            solve_lu(w.Kaa.data() + offset, modes, w.ra.data() + first, 1);
        }
        return regular;
    }

    /// K(i.., j..) -= tile.
    static auto subtract(std::vector<Real>& K) {
        return [&K](int i, int j, const Tile<Real>& sum) { add_tile<half>(K.data(), i, j, -1.0, sum); };
    }

    void condense_tangent(Workspace& w) const {
        for (const auto& [first, modes, offset] : tables_.groups)
            solve_ldlt(w.Kaa.data() + offset, modes, w.Kad.data() + first * size, size);
        const RowSet all{1, tables_.modes, 0, size};
        const Real *raw = w.Kda.data(), *solved = w.Kad.data();
        transposed_product<half>(all, raw, solved, true, subtract(w.Kmm));
        transposed_product<half>(all, raw + half, solved, false, subtract(w.Kdm));
        transposed_product<half>(all, raw + half, solved + half, true, subtract(w.Kdd));
    }

    void condense_tangent_full(Workspace& w) const {
        for (const auto& [first, modes, offset] : tables_.groups)
            solve_lu(w.Kaa.data() + offset, modes, w.Kad.data() + first * size, size);
        const RowSet all{1, tables_.modes, 0, size};
        const Real *raw = w.Kda.data(), *solved = w.Kad.data();
        transposed_product<half>(all, raw, solved, false, subtract(w.Kmm));
        transposed_product<half>(all, raw + half, solved, false, subtract(w.Kdm));
        transposed_product<half>(all, raw, solved + half, false, subtract(w.Kmd));
        transposed_product<half>(all, raw + half, solved + half, false, subtract(w.Kdd));
    }
};

}  // namespace umform
