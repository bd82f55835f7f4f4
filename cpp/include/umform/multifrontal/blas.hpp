// Dense products and triangular solves by the BLAS that the process has loaded: matrices by columns.
#pragma once

#include <algorithm>
#include <barrier>
#include <cstddef>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "umform/multifrontal/storage.hpp"

namespace umform::multifrontal {

/// The few functions of BLAS that fronts need, with 32-bit integers, and how to keep its own threads out.
struct Blas {
    using Gemm = void (*)(char*, char*, int*, int*, int*, double*, double*, int*, double*, int*, double*, double*,
                          int*);
    using Trsm = void (*)(char*, char*, char*, char*, int*, int*, double*, double*, int*, double*, int*);
    using Gemv = void (*)(char*, int*, int*, double*, double*, int*, double*, int*, double*, double*, int*);
    using Trsv = void (*)(char*, char*, char*, int*, double*, int*, double*, int*);
    using SetThreads = void (*)(int);
    using GetThreads = int (*)();
    Gemm gemm_ = nullptr;
    Trsm trsm_ = nullptr;
    Gemv gemv_ = nullptr;
    Trsv trsv_ = nullptr;
    SetThreads set_threads = nullptr;  // none if the library has no threads, or no function to set them
    GetThreads get_threads = nullptr;

    /// C = beta C + alpha op(A) op(B), C of m x n, k products a sum.
    void gemm(char ta, char tb, int m, int n, int k, double alpha, const double* a, int lda, const double* b, int ldb,
              double beta, double* c, int ldc) const {
        if (m == 0 || n == 0) return;
        gemm_(&ta, &tb, &m, &n, &k, &alpha, const_cast<double*>(a), &lda, const_cast<double*>(b), &ldb, &beta, c, &ldc);
    }

    /// B = op(T)^-1 B (side L) or B op(T)^-1 (side R), B of m x n.
    void trsm(char side, char triangle, char transposed, char unit, int m, int n, const double* t, int ldt, double* b,
              int ldb) const {
        double one = 1.0;
        if (m > 0 && n > 0)
            trsm_(&side, &triangle, &transposed, &unit, &m, &n, &one, const_cast<double*>(t), &ldt, b, &ldb);
    }

    /// Y -= op(A) X for few columns, A of m x n as it is stored.
    void subtract(char transposed, int m, int n, const double* a, int lda, const double* x, int ldx, double* y, int ldy,
                  int columns) const {
        double minus = -1.0, one = 1.0;
        int step = 1;
        if (m == 0 || n == 0) return;
        if (columns == 1)
            gemv_(&transposed, &m, &n, &minus, const_cast<double*>(a), &lda, const_cast<double*>(x), &step, &one, y,
                  &step);
        else
            gemm(transposed, 'N', transposed == 'N' ? m : n, columns, transposed == 'N' ? n : m, -1.0, a, lda, x, ldx,
                 1.0, y, ldy);
    }

    /// X = op(T)^-1 X for few columns.
    void divide(char triangle, char transposed, char unit, int n, const double* t, int ldt, double* x, int ldx,
                int columns) const {
        int step = 1;
        if (columns == 1)
            trsv_(&triangle, &transposed, &unit, &n, const_cast<double*>(t), &ldt, x, &step);
        else
            trsm('L', triangle, transposed, unit, n, columns, t, ldt, x, ldx);
    }
};

/// The BLAS of the process; empty until Python has handed it over.
inline Blas& blas() {
    static Blas functions;
    return functions;
}

/// While one lives, BLAS runs on the thread that calls it.
class OneBlasThread {
  public:
    OneBlasThread() {
        if (blas().set_threads == nullptr) return;
        const std::lock_guard lock(state().mutex);
        if (state().users++ > 0) return;
        state().before = blas().get_threads();
        if (state().before != 1) blas().set_threads(1);
    }
    ~OneBlasThread() {
        if (blas().set_threads == nullptr) return;
        const std::lock_guard lock(state().mutex);
        if (--state().users == 0 && state().before != 1) blas().set_threads(state().before);
    }
    OneBlasThread(const OneBlasThread&) = delete;
    OneBlasThread& operator=(const OneBlasThread&) = delete;

  private:
    struct State {
        std::mutex mutex;
        int users = 0, before = 1;
    };
    static State& state() {
        static State shared;
        return shared;
    }
};

/// Threads that make products together; while one lives, they have their buffers. OpenBLAS maps one for each large product that
/// is under way, and waits for ever where it gets no memory: all are mapped before the first product of the factors. Several
/// factorisations may run at a time, each in a thread of Python.
class Buffers {
  public:
    /// Takes, as a trial, the memory of new buffers and of as many numbers more, or throws.
    Buffers(int threads, std::size_t numbers) : threads_(threads) {
        const std::lock_guard lock(state().mutex);
        const int busy = state().busy + threads, missing = std::max(0, busy - state().mapped);
        {
            const Block room(numbers + static_cast<std::size_t>(missing) * size);
        }
        if (missing > 0) map(busy);
        state().busy = busy;
        state().mapped = std::max(busy, state().mapped);
    }
    ~Buffers() {
        const std::lock_guard lock(state().mutex);
        state().busy -= threads_;
    }
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;

  private:
    struct State {
        std::mutex mutex;
        int busy = 0, mapped = 0;  // threads of all that live, and the largest number so far
    };
    static constexpr std::size_t size = (std::size_t{160} << 20) / sizeof(double);  // of a buffer, at most
    int threads_;

    static State& state() {
        static State shared;
        return shared;
    }

    /// A large product on each of so many threads, all at the same time.
    static void map(int threads) {
        constexpr int n = 160;
        constexpr std::size_t entries = std::size_t{n} * n;
        const std::vector<double> a(entries, 1.0);
        std::vector<double> c(entries * threads);
        std::barrier together(threads);
        const auto multiply = [&](int thread) {
            together.arrive_and_wait();
            blas().gemm('N', 'T', n, n, n, 1.0, a.data(), n, a.data(), n, 0.0, c.data() + entries * thread, n);
        };
        std::vector<std::thread> others;
        others.reserve(threads);
        for (int thread = 1; thread < threads; ++thread) try {
                others.emplace_back(multiply, thread);
            } catch (const std::system_error&) {  // nor is there one for a product
                together.arrive_and_drop();
            }
        multiply(0);
        for (std::thread& other : others) other.join();
    }
};

}  // namespace umform::multifrontal
