#include "roadbed/tools/batch/input_cache.h"

#include <malloc.h>

#include <utility>

namespace roadbed::tools::inline batch {

InputCache::InputCache(FileHashes& files, std::uint64_t limit,
                       std::function<std::uint64_t()> resident)
    : files_(files), limit_(limit), resident_(std::move(resident)) {}

Inputs::Thing InputCache::get(const std::string& what,
                              const std::vector<std::filesystem::path>& files,
                              const std::function<Thing()>& make) const {
  std::string name = what;
  for (const auto& file : files) name += '\0' + file.native();
  const std::shared_ptr<Slot> slot = slot_of(name);
  const std::scoped_lock making(slot->mutex);
  const std::string before = state_of(files);
  if (slot->thing && slot->state == before) return slot->thing;
  slot->thing = nullptr;
  Thing thing = make();
  if (state_of(files) == before) {
    slot->thing = thing;
    slot->state = before;
  }
  {
    const std::scoped_lock lock(mutex_);
    ++made_;
  }
  shrink(limit_);
  return thing;
}

std::shared_ptr<InputCache::Slot> InputCache::slot_of(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  if (const auto* const known = slots_.find(name)) return *known;
  return slots_.put(name, std::make_shared<Slot>());
}

std::string InputCache::state_of(const std::vector<std::filesystem::path>& files) const {
  std::string state;
  for (const auto& file : files) state += files_.state_of(file) + '\n';
  return state;
}

bool InputCache::shrink(std::uint64_t limit) const {
  // Slots are handed out under the lock that is held here. Who has one may be waiting for this
  // lock, so that nobody is waited for.
  const auto is_idle = [](const std::shared_ptr<Slot>& slot) {
    if (slot.use_count() > 1) return false;
    const std::unique_lock lock(slot->mutex, std::try_to_lock);
    return lock.owns_lock() && slot->thing.use_count() <= 1;
  };
  bool has_shrunk = false;
  while (resident_() > limit) {
    {
      const std::scoped_lock lock(mutex_);
      if (!slots_.drop_one(is_idle)) break;
    }
    has_shrunk = true;
    ::malloc_trim(0);  // what is freed counts as resident until then
  }
  return has_shrunk;
}

std::size_t InputCache::made() const {
  const std::scoped_lock lock(mutex_);
  return made_;
}

}  // namespace roadbed::tools::batch
