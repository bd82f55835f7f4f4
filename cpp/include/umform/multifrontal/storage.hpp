// Memory of a factorisation: kept from one to the next, so that it is not asked for again each time.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

namespace umform {

/// Numbers without a value, aligned to a cache line.
class Block {
  public:
    Block() = default;
    explicit Block(std::size_t size)
        : data_(static_cast<double*>(::operator new[](size * sizeof(double), std::align_val_t{64}))), size_(size) {}
    double* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    void grow(std::size_t size) {
        if (size > size_) {
            *this = Block();
            *this = Block(size);
        }
    }

  private:
    struct Release {
        void operator()(double* p) const { ::operator delete[](p, std::align_val_t{64}); }
    };
    std::unique_ptr<double[], Release> data_;
    std::size_t size_ = 0;
};

/// Blocks that are released and reused, by several threads. Where none fits, smaller ones make room for a new one:
/// updates grow towards the root, and what is kept stays near to what is needed at one time.
class Pool {
  public:
    Block take(std::size_t size) {
        {
            const std::lock_guard lock(mutex_);
            const auto found = free_.lower_bound(size);
            if (found != free_.end() && found->first <= size + size / 2) {
                Block block = std::move(found->second);
                free_.erase(found);
                return block;
            }
            for (std::size_t freed = 0; freed < size && !free_.empty() && free_.begin()->first < size;) {
                const auto largest = std::prev(free_.lower_bound(size));
                freed += largest->first;
                free_.erase(largest);
            }
        }
        return Block(size);
    }
    void give(Block block) {
        if (block.size() == 0) return;
        const std::lock_guard lock(mutex_);
        const std::size_t size = block.size();
        free_.emplace(size, std::move(block));
    }

    /// Numbers in the free blocks.
    std::size_t held() {
        const std::lock_guard lock(mutex_);
        std::size_t sum = 0;
        for (const auto& block : free_) sum += block.first;
        return sum;
    }

  private:
    std::mutex mutex_;
    std::multimap<std::size_t, Block> free_;
};

/// Two stacks for the updates of a subtree: of fronts at an even and at an odd depth. When a front gives its update to one,
/// those of its children are on top of the other and leave it.
class Stacks {
  public:
    void reserve(std::size_t even, std::size_t odd) { stack_[0].grow(even), stack_[1].grow(odd); }
    void clear() { used_[0] = used_[1] = 0; }
    double* push(int depth, std::size_t size) {
        double* top = stack_[depth & 1].data() + used_[depth & 1];
        used_[depth & 1] += size;
        return top;
    }
    void pop(int depth, std::size_t size) { used_[depth & 1] -= size; }

  private:
    Block stack_[2];
    std::size_t used_[2] = {0, 0};
};

}  // namespace umform
