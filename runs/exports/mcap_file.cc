#include "runs/exports/mcap_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>

namespace hydro::exports {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr size_t kChunkSize = 1u << 20;  // bytes; a reader that seeks reads a whole chunk

enum Kind : uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd
};

// Writes a record's fields one after another, in little endian, the order of every machine that runs this
// program.
class Fields {
 public:
  template <class T>
  Fields& Number(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  Fields& Text(std::string_view text) {
    Number(static_cast<uint32_t>(text.size()));
    bytes_.append(text);
    return *this;
  }
  Fields& Bytes(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  // Adds data that are preceded by their length in bytes.
  Fields& List(const Fields& list) { return Text(list.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string Record(uint8_t kind, const std::string& content) {
  return Fields().Number(kind).Number(static_cast<uint64_t>(content.size())).Bytes(content).bytes();
}

Fields ListOf(const McapMap& entries) {
  Fields list;
  for (const auto& [key, value] : entries) list.Text(key).Text(value);
  return list;
}

Fields ListOf(const std::map<uint16_t, uint64_t>& numbers) {
  Fields list;
  for (const auto& [key, value] : numbers) list.Number(key).Number(value);
  return list;
}

uint32_t Checksum(uint32_t before, std::string_view bytes) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

}  // namespace

McapFile::McapFile(Output* out, const std::string& library) : out_(*out) {
  Emit(std::string(kMagic));
  EmitRecord(kHeader, Fields().Text("").Text(library).bytes());
}

void McapFile::Emit(const std::string& bytes) {
  out_.Write(bytes);
  position_ += bytes.size();
  checksum_ = Checksum(checksum_, bytes);
}

// Returns the record's length.
uint64_t McapFile::EmitRecord(uint8_t kind, const std::string& content) {
  const std::string record = Record(kind, content);
  Emit(record);
  return record.size();
}

uint16_t McapFile::AddSchema(const std::string& name, const std::string& encoding, const std::string& text) {
  const auto record = [&](uint16_t number) {
    return Record(kSchema, Fields().Number(number).Text(name).Text(encoding).Text(text).bytes());
  };
  for (size_t i = 0; i < schemas_.size(); ++i) {
    const auto number = static_cast<uint16_t>(i + 1);
    if (schemas_[i] == record(number)) return number;
  }
  schemas_.push_back(record(static_cast<uint16_t>(schemas_.size() + 1)));
  chunk_ += schemas_.back();
  return static_cast<uint16_t>(schemas_.size());
}

uint16_t McapFile::AddChannel(uint16_t schema, const std::string& topic, const std::string& encoding,
                              const McapMap& metadata) {
  const auto number = static_cast<uint16_t>(channels_.size() + 1);
  channels_.push_back(Record(
      kChannel,
      Fields().Number(number).Number(schema).Text(topic).Text(encoding).List(ListOf(metadata)).bytes()));
  chunk_ += channels_.back();
  messages_[number] = 0;
  return number;
}

void McapFile::AddMetadata(const std::string& name, const McapMap& entries) {
  Place place{name, "", position_};
  place.length = EmitRecord(kMetadata, Fields().Text(name).List(ListOf(entries)).bytes());
  metadata_.push_back(place);
}

void McapFile::AddAttachment(const std::string& name, const std::string& media_type,
                             const std::string& bytes) {
  Place place{name, media_type, position_};
  Fields content;
  content.Number(uint64_t{0}).Number(uint64_t{0}).Text(name).Text(media_type);
  content.Number(static_cast<uint64_t>(bytes.size())).Bytes(bytes);
  content.Number(Checksum(0, content.bytes()));
  place.length = EmitRecord(kAttachment, content.bytes());
  place.data_size = bytes.size();
  attachments_.push_back(place);
}

void McapFile::AddMessage(const McapMessage& message) {
  auto& index = in_chunk_[message.channel];
  const bool first = open_.first_time == 0 && open_.last_time == 0 && in_chunk_.size() == 1 && index.empty();
  open_.first_time = first ? message.log_time : std::min(open_.first_time, message.log_time);
  open_.last_time = std::max(open_.last_time, message.log_time);
  index.emplace_back(message.log_time, chunk_.size());
  Fields content;
  content.Number(message.channel)
      .Number(message.sequence)
      .Number(message.log_time)
      .Number(message.publish_time);
  chunk_ += Record(kMessage, content.Bytes(message.data).bytes());
  ++messages_[message.channel];
  if (chunk_.size() >= kChunkSize) FinishChunk();
}

void McapFile::FinishChunk() {
  if (chunk_.empty()) return;
  open_.start = position_;
  open_.size = chunk_.size();
  Fields content;
  content.Number(open_.first_time).Number(open_.last_time).Number(open_.size).Number(Checksum(0, chunk_));
  content.Text("").Number(open_.size).Bytes(chunk_);
  open_.length = EmitRecord(kChunk, content.bytes());
  for (const auto& [channel, messages] : in_chunk_) {
    open_.indexes[channel] = position_;
    Fields list;
    for (const auto& [time, place] : messages) list.Number(time).Number(place);
    open_.index_length += EmitRecord(kMessageIndex, Fields().Number(channel).List(list).bytes());
  }
  chunks_.push_back(std::move(open_));
  open_ = {};
  chunk_.clear();
  in_chunk_.clear();
}

std::string McapFile::ChunkIndex(const ChunkPlace& chunk) const {
  Fields content;
  content.Number(chunk.first_time).Number(chunk.last_time).Number(chunk.start).Number(chunk.length);
  content.List(ListOf(chunk.indexes))
      .Number(chunk.index_length)
      .Text("")
      .Number(chunk.size)
      .Number(chunk.size);
  return Record(kChunkIndex, content.bytes());
}

std::string McapFile::Statistics() const {
  uint64_t all = 0, first = 0, last = 0;
  for (const auto& [channel, count] : messages_) all += count;
  bool begun = false;
  for (const ChunkPlace& chunk : chunks_) {
    if (chunk.indexes.empty()) continue;
    first = begun ? std::min(first, chunk.first_time) : chunk.first_time;
    last = std::max(last, chunk.last_time);
    begun = true;
  }
  Fields content;
  content.Number(all).Number(static_cast<uint16_t>(schemas_.size()));
  for (const size_t count : {channels_.size(), attachments_.size(), metadata_.size(), chunks_.size()}) {
    content.Number(static_cast<uint32_t>(count));
  }
  return Record(kStatistics, content.Number(first).Number(last).List(ListOf(messages_)).bytes());
}

void McapFile::Finish() {
  FinishChunk();
  EmitRecord(kDataEnd, Fields().Number(checksum_).bytes());

  // First the groups of records of one kind, then where each group begins.
  std::vector<std::pair<uint8_t, std::string>> groups;
  const auto joined = [](const std::vector<std::string>& records) {
    std::string all;
    for (const std::string& record : records) all += record;
    return all;
  };
  groups.emplace_back(kSchema, joined(schemas_));
  groups.emplace_back(kChannel, joined(channels_));
  groups.emplace_back(kStatistics, Statistics());
  std::string chunks, attachments, metadata;
  for (const ChunkPlace& chunk : chunks_) chunks += ChunkIndex(chunk);
  for (const Place& place : attachments_) {
    Fields content;
    content.Number(place.start)
        .Number(place.length)
        .Number(uint64_t{0})
        .Number(uint64_t{0})
        .Number(place.data_size);
    attachments += Record(kAttachmentIndex, content.Text(place.name).Text(place.media_type).bytes());
  }
  for (const Place& place : metadata_) {
    metadata +=
        Record(kMetadataIndex, Fields().Number(place.start).Number(place.length).Text(place.name).bytes());
  }
  groups.emplace_back(kChunkIndex, chunks);
  groups.emplace_back(kAttachmentIndex, attachments);
  groups.emplace_back(kMetadataIndex, metadata);

  const uint64_t summary_start = position_;
  std::string summary, offsets;
  for (const auto& [kind, records] : groups) {
    if (records.empty()) continue;
    Fields content;
    content.Number(kind).Number(summary_start + summary.size()).Number(static_cast<uint64_t>(records.size()));
    offsets += Record(kSummaryOffset, content.bytes());
    summary += records;
  }
  const uint64_t offsets_start = summary_start + summary.size();
  summary += offsets;
  // The checksum covers the footer up to itself.
  constexpr uint64_t kFooterSize = 8 + 8 + 4;
  Fields footer;
  footer.Number(static_cast<uint8_t>(kFooter))
      .Number(kFooterSize)
      .Number(summary_start)
      .Number(offsets_start);
  summary += footer.bytes();
  Emit(Fields().Bytes(summary).Number(Checksum(0, summary)).Bytes(kMagic).bytes());
}

}  // namespace hydro::exports
