// SPDX-License-Identifier: MIT
// Objects of a VST3 host: what the plugin holds is the address of the first member, the table. They
// outlive every call, so nobody counts.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <travesty/audio_processor.h>
#include <travesty/edit_controller.h>
#include <travesty/host.h>

namespace knotwave::test {

inline v3_result V3_API no_interface(void*, const v3_tuid, void** object) {
  *object = nullptr;
  return V3_NO_INTERFACE;
}
inline std::uint32_t V3_API one(void*) { return 1; }
template <class Table>
void make_unknown(Table& table) {
  table.query_interface = no_interface;
  table.ref = one;
  table.unref = one;
}

struct Queue {
  v3_param_value_queue_cpp* table;
  v3_param_id id;
  std::vector<std::pair<std::int32_t, double>> points;

  static v3_param_value_queue_cpp* queue_table() {
    static v3_param_value_queue_cpp made = [] {
      v3_param_value_queue_cpp queue{};
      make_unknown(queue);
      queue.queue.get_param_id = [](void* self) { return static_cast<Queue*>(self)->id; };
      queue.queue.get_point_count = [](void* self) {
        return static_cast<std::int32_t>(static_cast<Queue*>(self)->points.size());
      };
      queue.queue.get_point = [](void* self, std::int32_t index, std::int32_t* sample,
                                 double* value) -> v3_result {
        const auto& point = static_cast<Queue*>(self)->points.at(static_cast<std::size_t>(index));
        *sample = point.first;
        *value = point.second;
        return V3_OK;
      };
      queue.queue.add_point = [](void* self, std::int32_t sample, double value,
                                 std::int32_t*) -> v3_result {
        static_cast<Queue*>(self)->points.emplace_back(sample, value);
        return V3_OK;
      };
      return queue;
    }();
    return &made;
  }
};

struct Changes {
  v3_param_changes_cpp* table = changes_table();
  std::vector<std::unique_ptr<Queue>> queues;

  void add(std::size_t sample, v3_param_id id, double value) {
    auto found = std::ranges::find(queues, id, [](const auto& queue) { return queue->id; });
    if (found == queues.end()) {
      queues.push_back(std::make_unique<Queue>(Queue{Queue::queue_table(), id, {}}));
      found = queues.end() - 1;
    }
    (*found)->points.emplace_back(static_cast<std::int32_t>(sample), value);
  }
  v3_param_changes** seen() { return reinterpret_cast<v3_param_changes**>(this); }

  static v3_param_changes_cpp* changes_table() {
    static v3_param_changes_cpp made = [] {
      v3_param_changes_cpp changes{};
      make_unknown(changes);
      changes.changes.get_param_count = [](void* self) {
        return static_cast<std::int32_t>(static_cast<Changes*>(self)->queues.size());
      };
      changes.changes.get_param_data = [](void* self, std::int32_t index) {
        return reinterpret_cast<v3_param_value_queue**>(
            static_cast<Changes*>(self)->queues.at(static_cast<std::size_t>(index)).get());
      };
      changes.changes.add_param_data = [](void* self, v3_param_id* id, std::int32_t* index) {
        auto& given = static_cast<Changes*>(self)->queues;
        given.push_back(std::make_unique<Queue>(Queue{Queue::queue_table(), *id, {}}));
        *index = static_cast<std::int32_t>(given.size()) - 1;
        return reinterpret_cast<v3_param_value_queue**>(given.back().get());
      };
      return changes;
    }();
    return &made;
  }
};

struct Events {
  v3_event_list_cpp* table = events_table();
  std::vector<v3_event> all;
  v3_event_list** seen() { return reinterpret_cast<v3_event_list**>(this); }

  static v3_event_list_cpp* events_table() {
    static v3_event_list_cpp made = [] {
      v3_event_list_cpp list{};
      make_unknown(list);
      list.list.get_event_count = [](void* self) {
        return static_cast<std::uint32_t>(static_cast<Events*>(self)->all.size());
      };
      list.list.get_event = [](void* self, std::int32_t index, v3_event* event) -> v3_result {
        *event = static_cast<Events*>(self)->all.at(static_cast<std::size_t>(index));
        return V3_OK;
      };
      list.list.add_event = [](void* self, v3_event* event) -> v3_result {
        static_cast<Events*>(self)->all.push_back(*event);
        return V3_OK;
      };
      return list;
    }();
    return &made;
  }
};

/// Reads and writes at most `at_once` bytes a call.
struct Stream {
  struct Table : v3_funknown {
    v3_bstream stream;
  };
  Table* table = stream_table();
  std::string bytes;
  std::size_t at_once = 0, place = 0;
  v3_bstream** seen() { return reinterpret_cast<v3_bstream**>(this); }

  static Table* stream_table() {
    static Table made = [] {
      Table stream{};
      make_unknown(stream);
      stream.stream.read = [](void* self, void* to, std::int32_t count,
                              std::int32_t* read) -> v3_result {
        auto& from = *static_cast<Stream*>(self);
        const std::size_t done = std::min(
            {static_cast<std::size_t>(count), from.at_once, from.bytes.size() - from.place});
        std::memcpy(to, from.bytes.data() + from.place, done);
        from.place += done;
        if (read != nullptr) *read = static_cast<std::int32_t>(done);
        return V3_OK;
      };
      stream.stream.write = [](void* self, void* from, std::int32_t count,
                               std::int32_t* written) -> v3_result {
        auto& to = *static_cast<Stream*>(self);
        const std::size_t done = std::min(static_cast<std::size_t>(count), to.at_once);
        to.bytes.append(static_cast<const char*>(from), done);
        if (written != nullptr) *written = static_cast<std::int32_t>(done);
        return V3_OK;
      };
      stream.stream.seek = [](void*, std::int64_t, std::int32_t, std::int64_t*) -> v3_result {
        return V3_NOT_IMPLEMENTED;
      };
      stream.stream.tell = [](void*, std::int64_t*) -> v3_result { return V3_NOT_IMPLEMENTED; };
      return stream;
    }();
    return &made;
  }
};

}  // namespace knotwave::test
