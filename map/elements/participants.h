#pragma once

#include <cstdint>
#include <initializer_list>

namespace roadbed::map::inline elements {

/// Kinds of road users.
enum class Participant : std::uint8_t {
  pedestrian,
  bicycle,
  motorcycle,
  car,
  taxi,
  bus,
  truck,
  emergency,
  tram,
  train,
};

/// A set of kinds of road users, as those that may use a lane.
class Participants {
 public:
  constexpr Participants() = default;
  constexpr Participants(std::initializer_list<Participant> kinds) {
    for (const Participant kind : kinds) add(kind);
  }
  static constexpr Participants from_bits(std::uint16_t bits) {
    Participants made;
    made.bits_ = bits;
    return made;
  }
  /// motorcycle, car, taxi, bus, truck, emergency
  static constexpr Participants vehicles() {
    return {Participant::motorcycle, Participant::car,   Participant::taxi,
            Participant::bus,        Participant::truck, Participant::emergency};
  }

  constexpr void add(Participant kind) { bits_ = static_cast<std::uint16_t>(bits_ | bit(kind)); }
  constexpr void remove(Participant kind) {
    bits_ = static_cast<std::uint16_t>(bits_ & ~bit(kind));
  }
  constexpr bool has(Participant kind) const { return (bits_ & bit(kind)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr std::uint16_t bits() const { return bits_; }
  constexpr bool operator==(const Participants&) const = default;

 private:
  static constexpr unsigned bit(Participant kind) { return 1U << static_cast<unsigned>(kind); }

  std::uint16_t bits_ = 0;
};

}  // namespace roadbed::map::elements
