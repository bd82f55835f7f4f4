// What a block of elements gives beside residual and tangent: one element, fields, energies. For the files that instantiate it.
#pragma once

#include <utility>

#include "umform/elements/block.hpp"

namespace umform {

template <int Nodes>
void ShellBlockOf<Nodes>::element(int e, const double* u, double* K, double* f) {
    prepare_workspaces(1);
    Workspace& w = workspaces_[0];
    const Batch batch = alone(e);
    std::vector<double> scratch(history_.stride());
    require(e, compute(batch, u, true, {}, filled(scratch.data()), w)[0]);
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) {
            const int i = k * Nodes + a;
            f[3 * a + k] = w.results.f[0][i];
            for (int b = 0; b < Nodes; ++b)
                for (int l = 0; l < 3; ++l) {
                    const int j = l * Nodes + b;
                    const int at = symmetric() ? std::min(i, j) * size + std::max(i, j) : i * size + j;
                    K[(3 * a + k) * size + 3 * b + l] = w.results.K[0][at];
                }
        }
}

template <int Nodes>
std::pair<int, Voigt> ShellBlockOf<Nodes>::failing_point(int e, const double* u) {
    prepare_workspaces(1);
    Workspace& w = workspaces_[0];
    const Batch batch = alone(e);
    std::vector<double> scratch(history_.stride());
    const LaneTrials trial = filled(scratch.data());
    if (!strains(batch, u, alpha_, w)[0]) return {-1, {}};
    LanePoints here = seen(batch, step, w);
    LaneMask first = false;
    first.set(0, true);
    for (int q = 0; q < points(); ++q) {
        LaneStates state;
        state.fill(history_.state(e) + static_cast<std::ptrdiff_t>(q) * state_size());
        if (!material_->respond(1, first, &w.shell.E[q], state, &w.shell.S[q], &w.shell.CC[q], trial, here)[0]) {
            Voigt E;
            for (int p = 0; p < 6; ++p) E[p] = w.shell.E[q][p][0];
            return {q, E};
        }
        if (here.axes != nullptr) ++here.axes;
    }
    return {-1, {}};
}

template <int Nodes>
void ShellBlockOf<Nodes>::fields(const double* u, const PointFields& out) {
    for_each_batch([&](int b, Workspace& w) {
        const Batch& batch = batches_.all[b];
        Failures failures{};
        LaneMask good = strains(batch, u, alpha_, w);
        mark(good, Failure::Inverted, failures);
        w.scratch.resize(lane_count * history_.stride());  // the trial history stays as it is
        LaneTrials scratch;
        for (int lane = 0; lane < lane_count; ++lane) scratch[lane] = w.scratch.data() + lane * history_.stride();
        good = respond(batch, good, scratch, 0.0, w);  // no time passes at a converged state
        mark(good | !batch.filled(), Failure::Law, failures);
        for (int lane = 0; lane < batch.count; ++lane) {
            failed_[batch.element[lane]] = failures[lane];
            if (failures[lane] == Failure::None) write_fields(batch.element[lane], lane, w, out);
        }
    });
    for (int e = 0; e < part_.size(); ++e) require(e, failed_[e]);
}

template <int Nodes>
void ShellBlockOf<Nodes>::write_fields(int e, int lane, const Workspace& w, const PointFields& out) const {
    for (int q = 0; q < points(); ++q) {
        const std::size_t at = static_cast<std::size_t>(e) * points() + q;
        for (int p = 0; p < 6; ++p) {
            out.E[6 * at + p] = w.shell.E[q][p][lane];
            out.S[6 * at + p] = w.shell.S[q][p][lane];
        }
        write_base(q, lane, w, out.frame + 9 * at, out.F + 9 * at);
        out.dV[at] = w.shell.dV[q][lane];
    }
}

template <int Nodes>
Energy ShellBlockOf<Nodes>::energy(const double* u) {
    for_each_batch([&](int b, Workspace& w) {
        const Batch& batch = batches_.all[b];
        const LaneMask valid = strains(batch, u, alpha_converged_, w);
        for (int lane = 0; lane < batch.count; ++lane) {
            const int e = batch.element[lane];
            energy_[e] = Energy{};
            if (!valid[lane]) continue;
            for (int q = 0; q < points(); ++q)
                for (int p = 0; p < 6; ++p) w.E[q][p] = w.shell.E[q][p][lane];
            material_->energy(points(), w.E.data(), history_.state(e), w.energy.data(), number_of(e));
            energy_[e] = {0.0, 0.0};
            for (int q = 0; q < points(); ++q) {
                energy_[e].elastic += w.energy[q].elastic * w.shell.dV[q][lane];
                energy_[e].plastic += w.energy[q].plastic * w.shell.dV[q][lane];
            }
        }
    });
    Energy total{0.0, 0.0};  // in the order of the elements, whatever the number of threads
    for (const Energy& one : energy_) {
        total.elastic += one.elastic;
        total.plastic += one.plastic;
    }
    return total;
}

template <int Nodes>
void ShellBlockOf<Nodes>::check_rolling() {
    if (rolling_.empty()) return;
    if (rolling_.size() != 3 && rolling_.size() != 3 * static_cast<std::size_t>(part_.size()))
        throw std::invalid_argument("rolling is one vector, or one for each cell");
    prepare_workspaces(1);
    Workspace& w = workspaces_[0];
    const std::vector<double> at_rest(X_.size()), parameters(alpha_.size());
    for (const Batch& batch : batches_.all) {
        strains(batch, at_rest.data(), parameters, w);
        element_.axes(nullptr, w.shell, w.axes);
        for (const Axes<Lanes>& e : w.axes) {
            const Lanes r1 = dot(w.rolling, e[0]), r2 = dot(w.rolling, e[1]);
            const LaneMask in_plane = r1 * r1 + r2 * r2 > 1e-6 * dot(w.rolling, w.rolling);
            for (int lane = 0; lane < batch.count; ++lane)
                if (!in_plane[lane])
                    throw std::invalid_argument("the rolling direction stands on the sheet in cell "
                                                + std::to_string(number_of(batch.element[lane])));
        }
    }
}

template <int Nodes>
void ShellBlockOf<Nodes>::write_base(int q, int lane, const Workspace& w, double* frame, double* F) const {
    std::array<Vec3, 3> G, g;
    element_.base_vectors(q, lane, w.shell, G, g);
    const Axes<double> local = rolling_.empty()
                                   ? local_frame(G)
                                   : local_frame(G, Vec3{w.rolling[0][lane], w.rolling[1][lane], w.rolling[2][lane]});
    const Mat3 G_inverse = inverse(columns(G));
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            frame[3 * i + k] = local[i][k];
            F[3 * i + k] = g[0][i] * G_inverse(0, k) + g[1][i] * G_inverse(1, k) + g[2][i] * G_inverse(2, k);
        }
}

}  // namespace umform
