// What a block of elements gives beside residual and tangent: one element, fields, energies. For the files that instantiate it.
#pragma once

#include <utility>

#include "umform/elements/block.hpp"
#include "umform/elements/cauchy.hpp"

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
template <class Write>
void ShellBlockOf<Nodes>::for_each_response(const double* u, const Write& write) {
    for_each_batch(points(), [&](int b, Workspace& w, const auto&) {
        const Batch& batch = batches_[b];
        Failures failures{};
        LaneMask good = strains(batch, u, alpha_, w);
        mark(good, Failure::Inverted, failures);
        w.scratch.resize(lane_count * history_.stride());  // the trial history is unchanged
        LaneTrials scratch;
        for (int lane = 0; lane < lane_count; ++lane) scratch[lane] = w.scratch.data() + lane * history_.stride();
        good = respond(batch, good, scratch, 0.0, w);  // no time passes at a converged state
        mark(good | !batch.filled(), Failure::Law, failures);
        LaneMask known = false;
        for (int lane = 0; lane < batch.count; ++lane) {
            failed_[batch.element[lane]] = failures[lane];
            known.set(lane, failures[lane] == Failure::None);
        }
        write(batch, known, w);
    });
    for (int e = 0; e < part_.size(); ++e) require(e, failed_[e]);
}

template <int Nodes>
void ShellBlockOf<Nodes>::fields(const double* u, const PointFields& out) {
    for_each_response(u, [&](const Batch& batch, LaneMask known, const Workspace& w) {
        for (int lane = 0; lane < batch.count; ++lane)
            if (known[lane]) write_fields(batch.element[lane], lane, w, out);
    });
}

template <int Nodes>
void ShellBlockOf<Nodes>::fields(const double* u, const CellFields& out) {
    for_each_response(
        u, [&](const Batch& batch, LaneMask known, const Workspace& w) { write_fields(batch, known, w, out); });
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
void ShellBlockOf<Nodes>::write_fields(const Batch& batch, LaneMask good, const Workspace& w,
                                       const CellFields& out) const {
    std::array<Vec<Lanes, 6>, 4> sums{};
    Lanes volume = 0.0, mises = 0.0;
    for (int q = 0; q < points(); ++q) {
        Mat<Lanes, 3, 3> frame, F;
        for (int lane = 0; lane < lane_count; ++lane) {
            Mat3 frame_of, F_of;
            write_base(q, lane, w, frame_of.a.data(), F_of.a.data());
            for (int i = 0; i < 9; ++i) frame.a[i].set(lane, frame_of.a[i]), F.a[i].set(lane, F_of.a[i]);
        }
        const Stresses<Lanes> at = stresses<Lanes>(w.shell.E[q], w.shell.S[q], frame, F);
        const std::array<const Vec<Lanes, 6>*, 4> kinds{&at.cauchy, &at.cauchy_local, &at.pk2, &w.shell.S[q]};
        for (int kind = 0; kind < 4; ++kind)
            for (int p = 0; p < 6; ++p) sums[kind][p] += w.shell.dV[q] * (*kinds[kind])[p];
        volume += w.shell.dV[q];
        const Lanes here = von_mises(at.cauchy_local);
        mises = select(here > mises, here, mises);
    }
    for (int lane = 0; lane < batch.count; ++lane) {
        if (!good[lane]) continue;
        const std::size_t e = batch.element[lane];
        for (int kind = 0; kind < 4; ++kind)
            for (int p = 0; p < 6; ++p) out.stresses[kind][6 * e + p] = sums[kind][p][lane] / volume[lane];
        out.von_mises[e] = mises[lane];
        if (out.scalar < 0) continue;
        const double* history = history_.state(batch.element[lane]) + out.scalar;
        double sum = 0.0, largest = history[0];
        for (int q = 0; q < points(); ++q) {
            const double value = history[static_cast<std::size_t>(q) * history_.size()];
            sum += value * w.shell.dV[q][lane];
            largest = std::max(largest, value);
        }
        out.mean[e] = sum / volume[lane];
        out.largest[e] = largest;
    }
}

template <int Nodes>
Energy ShellBlockOf<Nodes>::energy(const double* u) {
    for_each_batch(points(), [&](int b, Workspace& w, const auto&) {
        const Batch& batch = batches_[b];
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
    Energy total{0.0, 0.0};  // in the order of the elements, for any number of threads
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
    for (const Batch& batch : batches_) {
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
