#pragma once

/// Makes memory run out on purpose. Linked into a test program, it stands in for malloc and its kin in the whole
/// process, libraries included; in a program built with sanitizers, which have a malloc of their own, for operator new.
namespace multires::faults {

enum class Shortage {
    once,    ///< the one allocation fails, later ones succeed
    lasting  ///< it and all later ones fail
};

enum class Memory {
    all,
    large  ///< half a megabyte and more; other allocations are not counted and do not fail
};

/// From now on, in any thread, allocation number `index` (from 0) fails.
void fail_at(long index, Shortage shortage = Shortage::once, Memory memory = Memory::all);

/// From now on allocations are counted, none fails.
void count(Memory memory = Memory::all);

/// Allocations since fail_at() or count(), which end here.
long stop();

}  // namespace multires::faults
