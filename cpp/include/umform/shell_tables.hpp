// What is the same for all elements of a kind, computed once: shape gradients, tying weights, values of the modes.
#pragma once

#include <vector>

#include "umform/quadrature.hpp"
#include "umform/technology.hpp"
#include "umform/topology.hpp"

namespace umform {

/// Gauss points are numbered q = layer * surface + point of the surface. Tying samples are stored for the mid-surface, then
/// layer by layer.
template <int Nodes>
struct ShellTables {
    struct Sample {
        int component;
        std::array<double, Nodes> Ni, Nj;
    };
    struct Row {
        bool at_layer;
        int first, count;  // samples, counted inside the mid-surface or inside a layer
        int first_weight;  // in tying_weights, then [surface point][sample]
    };
    struct ModeEntry {
        int component, mode;  // component: position in enhanced
    };

    ShellTables(const Technology& technology, const Rule& surface_rule, const Rule& thickness)
        : surface(surface_rule.size() * surface_rule.size()), layers(thickness.size()) {
        tabulate_gauss_points(surface_rule, thickness);
        tabulate_tying(technology, surface_rule, thickness);
        tabulate_modes(technology, surface_rule, thickness);
    }

    int points() const { return surface * layers; }
    double tying_weight(const Row& row, int q, int k) const {
        return tying_weights[row.first_weight + (q % surface) * row.count + k];
    }
    int first_sample(const Row& row, int q) const {
        return row.at_layer ? mid_samples + (q / surface) * layer_samples + row.first : row.first;
    }
    /// The same among the samples of the mid-surface and of the layer at work.
    int first_sample_of_pass(const Row& row) const { return row.at_layer ? mid_samples + row.first : row.first; }

    int surface, layers, modes = 0;
    int mid_samples = 0, layer_samples = 0;
    std::vector<ShellGradient<Nodes>> gauss;  // [q]
    std::vector<double> weight;               // [q]
    ShellGradient<Nodes> centre;
    std::array<int, 6> row_of;  // component -> row of the tying rule, or -1
    std::vector<Row> rows;
    std::vector<double> tying_weights;
    std::vector<Sample> samples;      // of the mid-surface, then layer by layer
    std::vector<int> enhanced;        // enhanced components
    std::vector<ModeEntry> entries;   // which component of which mode is not zero
    std::vector<double> mode_values;  // [q][entry]

  private:
    void tabulate_gauss_points(const Rule& surface_rule, const Rule& thickness) {
        for (int layer = 0; layer < layers; ++layer)
            for (int is = 0; is < surface_rule.size(); ++is)
                for (int ir = 0; ir < surface_rule.size(); ++ir) {
                    gauss.push_back(shell_gradient<Nodes>(surface_rule.x[ir], surface_rule.x[is], thickness.x[layer]));
                    weight.push_back(surface_rule.w[ir] * surface_rule.w[is] * thickness.w[layer]);
                }
        centre = shell_gradient<Nodes>(0.0, 0.0, 0.0);
    }

    void tabulate_tying(const Technology& technology, const Rule& surface_rule, const Rule& thickness) {
        row_of.fill(-1);
        for (const Tying& tying : technology.tying) {
            int& known = tying.at_layer ? layer_samples : mid_samples;
            const int count = static_cast<int>(tying.r.size() * tying.s.size());
            row_of[tying.component] = static_cast<int>(rows.size());
            rows.push_back({tying.at_layer, known, count, static_cast<int>(tying_weights.size())});
            known += count;
            for (const double s : surface_rule.x)
                for (const double r : surface_rule.x)
                    for (const double ws : lagrange(tying.s, s))
                        for (const double wr : lagrange(tying.r, r)) tying_weights.push_back(wr * ws);
        }
        add_samples(technology, false, 0.0);
        for (const double t : thickness.x) add_samples(technology, true, t);
    }

    void add_samples(const Technology& technology, bool at_layer, double t) {
        for (const Tying& tying : technology.tying) {
            if (tying.at_layer != at_layer) continue;
            const auto [i, j] = voigt_pair[tying.component];
            for (const double s : tying.s)
                for (const double r : tying.r) {
                    const ShellGradient<Nodes> dN = shell_gradient<Nodes>(r, s, t);
                    samples.push_back({tying.component, dN[i], dN[j]});
                }
        }
    }

    void tabulate_modes(const Technology& technology, const Rule& surface_rule, const Rule& thickness) {
        modes = static_cast<int>(technology.modes.size());
        std::array<int, 6> position;
        position.fill(-1);
        for (const Mode& mode : technology.modes)
            for (const Term& term : mode)
                if (position[term.component] < 0) {
                    position[term.component] = static_cast<int>(enhanced.size());
                    enhanced.push_back(term.component);
                }
        for (int m = 0; m < modes; ++m)
            for (const int component : enhanced)
                for (const Term& term : technology.modes[m])
                    if (term.component == component
                        && (entries.empty() || entries.back().mode != m
                            || entries.back().component != position[component]))
                        entries.push_back({position[component], m});
        for (const double t : thickness.x)
            for (const double s : surface_rule.x)
                for (const double r : surface_rule.x)
                    for (const ModeEntry& entry : entries) {
                        double value = 0.0;
                        for (const Term& term : technology.modes[entry.mode])
                            if (term.component == enhanced[entry.component]) value += term(r, s, t);
                        mode_values.push_back(value);
                    }
    }
};

}  // namespace umform
