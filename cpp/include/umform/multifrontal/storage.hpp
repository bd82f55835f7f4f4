// Memory of a factorisation: kept from one to the next, so that it is not asked for again each time.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

namespace umform::multifrontal {

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

/// Two stacks for the updates of a subtree, which grow towards each other: of fronts at an even and at an odd depth. When a
/// front gives its update to one, those of its children are on top of the other and leave it.
class Stacks {
  public:
    void use(double* data, std::size_t size) { data_ = data, used_[0] = 0, used_[1] = size; }
    double* push(int depth, std::size_t size) {
        if ((depth & 1) != 0) return data_ + (used_[1] -= size);
        used_[0] += size;
        return data_ + used_[0] - size;
    }
    void pop(int depth, std::size_t size) { (depth & 1) != 0 ? used_[1] += size : used_[0] -= size; }

  private:
    double* data_ = nullptr;
    std::size_t used_[2] = {0, 0};  // end of the first, begin of the second
};

/// Memory that is given out from both of its ends, to several threads. On one thread these are two stacks, see `Stacks`.
class Arena {
  public:
    static constexpr std::size_t line =
        64 / sizeof(double);  // numbers of a cache line, which all sizes are multiples of
    static std::size_t padded(std::size_t size) { return (size + line - 1) / line * line; }

    void reset(double* data, std::size_t size) {
        data_ = data;
        free_.clear();
        if (size > 0) free_[0] = size;
    }
    /// Numbers near the first or the last end, none before `floor`; nullptr where there are not so many.
    double* take(std::size_t size, bool last, std::size_t floor) {
        const std::lock_guard lock(mutex_);
        return last ? take(free_.rbegin(), free_.rend(), size, last, floor)
                    : take(free_.begin(), free_.end(), size, last, floor);
    }
    void give(double* data, std::size_t size) {
        const std::lock_guard lock(mutex_);
        const std::size_t begin = data - data_;
        auto here = free_.emplace(begin, begin + size).first;
        if (const auto next = std::next(here); next != free_.end() && next->first == here->second) {
            here->second = next->second;
            free_.erase(next);
        }
        if (here == free_.begin()) return;
        if (const auto before = std::prev(here); before->second == begin) {
            before->second = here->second;
            free_.erase(here);
        }
    }

  private:
    std::mutex mutex_;
    double* data_ = nullptr;
    std::map<std::size_t, std::size_t> free_;  // begin -> end

    template <class Iterator>
    double* take(Iterator range, const Iterator& end, std::size_t size, bool last, std::size_t floor) {
        for (; range != end; ++range) {
            const std::size_t first = std::max(range->first, floor), behind = range->second;
            if (behind < first + size) continue;
            const std::size_t begin = last ? behind - size : first, from = range->first;
            free_.erase(from);
            if (from < begin) free_[from] = begin;
            if (begin + size < behind) free_[begin + size] = behind;
            return data_ + begin;
        }
        return nullptr;
    }
};

/// Memory that is free between factorisations, for one user at a time; a block of its own where it is too small or taken.
class Lent {
  public:
    Lent(std::atomic_flag& taken, double* data, std::size_t there, std::size_t size) : data_(data) {
        if (size <= there && !taken.test_and_set(std::memory_order_acquire))
            taken_ = &taken;
        else
            own_ = Block(size), data_ = own_.data();
    }
    ~Lent() {
        if (taken_ != nullptr) taken_->clear(std::memory_order_release);
    }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    double* data() const { return data_; }

  private:
    std::atomic_flag* taken_ = nullptr;
    double* data_;
    Block own_;
};

/// Memory for an update, or for the stacks of a subtree.
struct Room {
    double* data = nullptr;
    std::size_t size = 0;
    Block own;  // where it is not in the arena

    static Room of(Arena& arena, Pool& pool, std::size_t size, bool last, std::size_t floor) {
        Room room{nullptr, Arena::padded(size), Block()};
        if (size == 0) return room;
        room.data = arena.take(room.size, last, floor);
        if (room.data == nullptr) room.own = pool.take(size), room.data = room.own.data();
        return room;
    }
    void release(Arena& arena, Pool& pool) {
        if (own.size() > 0)
            pool.give(std::move(own));
        else if (data != nullptr)
            arena.give(data, size);
        *this = Room();
    }
};

}  // namespace umform::multifrontal
