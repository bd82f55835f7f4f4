// What is the same for all elements of a kind, computed once: shape functions, tying weights, values of the modes.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "umform/elements/quadrature.hpp"
#include "umform/elements/technology.hpp"
#include "umform/elements/topology.hpp"

namespace umform {

/// Gauss points are numbered q = layer * surface + point of the surface; the points over one point of the surface are a column,
/// which may have heights of its own. All that depends on (r, s) is tabulated at places: the Gauss points of the surface come
/// first, then the tying points, each once.
template <int Nodes>
struct ShellTables {
    static constexpr int face = Nodes / 2;

    struct Place {
        double r, s;
        FaceShape<face> shape;
    };
    struct Sample {
        int component, place;
    };
    /// A share of a tied strain at a Gauss point: weight times a sample of the mid-surface or of the layer.
    struct Share {
        int sample;
        double weight;
    };
    struct Row {
        bool at_layer;
        std::vector<std::vector<Share>> shares;  // [surface point]
    };
    /// Value of a mode in one enhanced component at a Gauss point where it is not zero.
    struct ModeEntry {
        int component, mode;  // component: position in enhanced
        double value;
    };
    /// Modes that follow each other and share no Gauss point with others: a diagonal block of Kaa, `offset` entries behind the first.
    struct ModeGroup {
        int first, size, offset;
    };

    ShellTables(const Technology& technology, const SurfaceRule& surface_rule, const ThicknessRule& thickness)
        : surface(surface_rule.size()), layers(thickness.size()), modes_of(surface) {
        thickness.require(surface);
        tabulate_gauss_points(technology, surface_rule, thickness);
        for (const Tying& tying : technology.tying) tabulate_tying(tying, surface_rule);
        centre = place(0.0, 0.0);
        tabulate_modes(technology, thickness);
    }

    int points() const { return surface * layers; }

    int surface, layers, modes = 0, centre = 0;
    std::vector<double> t;       // [q]
    std::vector<double> weight;  // [q]
    std::vector<Place> places;
    std::array<int, 6> row_of;  // component -> row of the tying rule, or -1
    std::vector<Row> rows;
    std::vector<Sample> mid_samples, layer_samples;
    std::vector<int> enhanced;                    // enhanced components
    std::vector<std::vector<ModeEntry>> entries;  // [q], by modes
    std::vector<ModeGroup> groups;
    std::vector<int> group_of;               // [q]
    std::vector<std::vector<int>> modes_of;  // [surface point] modes that are not zero at all points of the column

    /// Entries of all diagonal blocks of Kaa.
    int group_entries() const {
        return groups.empty() ? 0 : groups.back().offset + groups.back().size * groups.back().size;
    }

  private:
    int place(double r, double s) {
        for (std::size_t k = 0; k < places.size(); ++k)
            if (places[k].r == r && places[k].s == s) return static_cast<int>(k);
        places.push_back({r, s, face_shape<face>(r, s)});
        return static_cast<int>(places.size()) - 1;
    }

    void tabulate_gauss_points(const Technology& technology, const SurfaceRule& surface_rule,
                               const ThicknessRule& thickness) {
        row_of.fill(-1);
        for (std::size_t row = 0; row < technology.tying.size(); ++row)
            row_of[technology.tying[row].component] = static_cast<int>(row);
        for (const double s : surface_rule.s.x)
            for (const double r : surface_rule.r.x) place(r, s);
        for (int layer = 0; layer < layers; ++layer) {
            int column = 0;
            for (const double ws : surface_rule.s.w)
                for (const double wr : surface_rule.r.w) {
                    const Rule& rule = thickness[column++];
                    t.push_back(rule.x[layer]);
                    weight.push_back(wr * ws * rule.w[layer]);
                }
        }
    }

    void tabulate_tying(const Tying& tying, const SurfaceRule& surface_rule) {
        std::vector<Sample>& samples = tying.at_layer ? layer_samples : mid_samples;
        const int first = static_cast<int>(samples.size());
        for (const double s : tying.s)
            for (const double r : tying.r) samples.push_back({tying.component, place(r, s)});
        Row row{tying.at_layer, {}};
        for (const double s : surface_rule.s.x)
            for (const double r : surface_rule.r.x) {
                std::vector<Share>& shares = row.shares.emplace_back();
                int sample = first;
                for (const double ws : lagrange(tying.s, s))
                    for (const double wr : lagrange(tying.r, r)) {
                        // Where Gauss and tying points coincide, a weight is zero but for the round-off of both.
                        if (std::abs(wr * ws) > 1e-14) shares.push_back({sample, wr * ws});
                        ++sample;
                    }
            }
        rows.push_back(std::move(row));
    }

    void tabulate_modes(const Technology& technology, const ThicknessRule& thickness) {
        modes = static_cast<int>(technology.modes.size());
        std::array<int, 6> position;
        position.fill(-1);
        for (const Mode& mode : technology.modes)
            for (const Polynomial& polynomial : mode)
                if (position[polynomial.component] < 0) {
                    position[polynomial.component] = static_cast<int>(enhanced.size());
                    enhanced.push_back(polynomial.component);
                }
        std::vector<std::vector<double>> means;
        means.reserve(surface);
        for (int p = 0; p < surface; ++p) means.push_back(legendre_means(technology, thickness[p]));
        for (int q = 0; q < points(); ++q) {
            const int p = q % surface;
            std::vector<ModeEntry>& of_point = entries.emplace_back();
            for (int m = 0; m < modes; ++m)
                add_entries(technology.modes[m], m, {places[p].r, places[p].s, t[q]}, means[p], position, of_point);
        }
        group_modes();
    }

    /// Mean of each Legendre polynomial of the modes under the rule of a column; zero, but for round-off, where the rule is exact. A mean
    /// that is left would let a constant stress work on the modes. eq. (2.48)
    static std::vector<double> legendre_means(const Technology& technology, const Rule& thickness) {
        int most = 0;
        for (const Mode& mode : technology.modes)
            for (const Polynomial& polynomial : mode) most = std::max(most, polynomial.c);
        std::vector<double> means(most + 1, 0.0);
        for (int c = 1; c <= most; ++c) {
            for (int k = 0; k < thickness.size(); ++k)
                means[c] += 0.5 * thickness.w[k] * legendre(c, thickness.x[k]).value;
            if (std::abs(means[c]) < 1e-14) means[c] = 0.0;
        }
        return means;
    }

    /// Values of a mode at a Gauss point, but for those that are zero: of a polynomial with its roots at other points nothing is
    /// left but the round-off of its terms.
    void add_entries(const Mode& mode, int number, const Vec<double, 3>& at, const std::vector<double>& means,
                     const std::array<int, 6>& position, std::vector<ModeEntry>& of_point) {
        for (const int component : enhanced) {
            double value = 0.0, size = 0.0;
            for (const Polynomial& polynomial : mode)
                if (polynomial.component == component) {
                    const double part = polynomial(at[0], at[1], at[2], means[polynomial.c]);
                    value += part, size += std::abs(part);
                }
            if (std::abs(value) > 1e-14 * size) of_point.push_back({position[component], number, value});
        }
    }

    void group_modes() {
        std::vector<bool> begins(modes, true);
        for (const auto& of_point : entries)
            if (!of_point.empty())
                for (int m = of_point.front().mode + 1; m <= of_point.back().mode; ++m) begins[m] = false;
        for (int m = 0; m < modes; ++m)
            if (begins[m])
                groups.push_back({m, 1, group_entries()});
            else
                ++groups.back().size;
        for (const auto& of_point : entries) {
            int group = 0;
            while (!of_point.empty() && groups[group].first + groups[group].size <= of_point.front().mode) ++group;
            group_of.push_back(group);
        }
        for (int p = 0; p < surface; ++p)
            for (int m = 0; m < modes; ++m) {
                bool seen = false;
                for (int q = p; q < points(); q += surface)
                    for (const ModeEntry& entry : entries[q]) seen = seen || entry.mode == m;
                if (seen) modes_of[p].push_back(m);
            }
    }
};

}  // namespace umform
