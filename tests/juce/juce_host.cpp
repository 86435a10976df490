// SPDX-License-Identifier: MIT
// A host made of JUCE, for tests: does what a script says, a command a line, its words apart by
// tabs, and answers on stdout. With JUCE in it this program is under the GPL, and is never shipped.
//
//   juce_host vst3|lv2 SCRIPT
//
//   scan FOLDER                 all it finds, a line each, then "scanned"
//   load NAME RATE_HZ FRAMES    one of them, with blocks of at most FRAMES and every bus; a fourth
//                               word leaves the buses as the plugin says
//   prepare RATE_HZ FRAMES, reset
//   parameters                  name, unit, value (0 to 1) and text of each
//   set NAME VALUE              as a knob does
//   text NAME VALUE, value NAME TEXT
//   programs, program NAME
//   midi SAMPLE BYTE BYTE BYTE, point SAMPLE NAME VALUE    of the next play
//   song BPM QUARTERS 0|1       the host's, from the next block on
//   play FRAMES BLOCK IN OUT    files of floats, one channel after the other; IN may be -;
//                               OUT.midi has what it gave: sample and bytes of each
//   save FILE, restore FILE
//   mangle FROM TO FILE NEW     a state whose last FROM is TO
//   german                      the locale de_DE.UTF-8
//   destroy
#include <clocale>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <juce_audio_processors/juce_audio_processors.h>

namespace {

using Words = std::vector<std::string>;

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

double number(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double read = 0;
  if (!(in >> read)) fail("no number: " + text);
  return read;
}
int whole(const std::string& text) { return static_cast<int>(number(text)); }

std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail("cannot read " + path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  if (!(out << text)) fail("cannot write " + path);
}

/// A song that a test tells, and that runs on by itself where it plays.
class Song : public juce::AudioPlayHead {
 public:
  void tell(double bpm, double quarters, bool plays) {
    bpm_ = bpm;
    quarters_ = quarters;
    plays_ = plays;
    is_told_ = true;
  }
  void pass(int frames, double rate_hz) {
    samples_ += frames;
    if (plays_) quarters_ += frames * bpm_ / (60 * rate_hz);
  }
  juce::Optional<PositionInfo> getPosition() const override {
    if (!is_told_) return {};
    PositionInfo info;
    info.setTimeInSamples(samples_);
    if (bpm_ > 0) info.setBpm(bpm_);
    info.setPpqPosition(quarters_);
    info.setTimeSignature(juce::AudioPlayHead::TimeSignature{4, 4});
    info.setPpqPositionOfLastBarStart(4 * std::floor(quarters_ / 4));
    info.setIsPlaying(plays_);
    return info;
  }

 private:
  double bpm_ = 0, quarters_ = 0;
  bool plays_ = false, is_told_ = false;
  std::int64_t samples_ = 0;
};

class Host {
 public:
  explicit Host(const std::string& format) {
    if (format == "vst3") format_ = std::make_unique<juce::VST3PluginFormat>();
    if (format == "lv2") format_ = std::make_unique<juce::LV2PluginFormat>();
    if (format_ == nullptr) fail("no such format: " + format);
    std::cout.precision(std::numeric_limits<double>::max_digits10);
  }
  ~Host() { destroy({}); }

  void run(std::istream& script) {
    const std::map<std::string, void (Host::*)(const Words&)> verbs = {
        {"scan", &Host::scan},       {"load", &Host::load},     {"prepare", &Host::prepare},
        {"reset", &Host::reset},     {"set", &Host::set},       {"parameters", &Host::list},
        {"text", &Host::text},       {"value", &Host::value},   {"programs", &Host::programs},
        {"program", &Host::program}, {"midi", &Host::midi},     {"point", &Host::point},
        {"song", &Host::song},       {"play", &Host::play},     {"save", &Host::save},
        {"restore", &Host::restore}, {"mangle", &Host::mangle}, {"german", &Host::speak_german},
        {"destroy", &Host::destroy}};
    for (std::string line; std::getline(script, line);) {
      Words words;
      std::istringstream in(line);
      for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
      const auto found = verbs.find(words.at(0));
      if (found == verbs.end()) fail("no such command: " + line);
      (this->*found->second)({words.begin() + 1, words.end()});
    }
  }

 private:
  void scan(const Words& words) {
    const juce::FileSearchPath path{juce::String(words.at(0))};
    juce::PluginDirectoryScanner scanner(known_, *format_, path, true, juce::File());
    juce::String name;
    while (scanner.scanNextFile(true, name)) {
    }
    for (const juce::String& failed : scanner.getFailedFiles())
      fail("failed: " + failed.toStdString());
    for (const auto& type : known_.getTypes()) {
      std::cout << type.name << '\t' << type.manufacturerName << '\t' << type.category << '\t'
                << type.isInstrument << '\t' << type.numInputChannels << '\t'
                << type.numOutputChannels << '\n';
    }
    std::cout << "scanned\n";
  }
  void load(const Words& words) {
    destroy({});
    const double rate_hz = number(words.at(1));
    const int frames = whole(words.at(2));
    for (const auto& type : known_.getTypes()) {
      if (type.name.toStdString() != words.at(0)) continue;
      juce::String error;
      plugin_ = format_->createInstanceFromDescription(type, rate_hz, frames, error);
      if (plugin_ == nullptr) fail("not loaded: " + error.toStdString());
    }
    if (plugin_ == nullptr) fail("not found: " + words.at(0));
    if (words.size() == 3) plugin_->enableAllBuses();
    plugin_->setPlayHead(&song_);
    prepare({words.at(1), words.at(2)});
  }
  void prepare(const Words& words) {
    rate_hz_ = number(words.at(0));
    plugin().prepareToPlay(rate_hz_, whole(words.at(1)));
  }
  void reset(const Words&) { plugin().reset(); }
  void destroy(const Words&) { plugin_.reset(); }

  juce::AudioPluginInstance& plugin() {
    if (plugin_ == nullptr) fail("nothing is loaded");
    return *plugin_;
  }
  juce::AudioProcessorParameter& parameter(const std::string& name) {
    for (juce::AudioProcessorParameter* one : plugin().getParameters()) {
      if (one->getName(1024).toStdString() == name) return *one;
    }
    fail("no such parameter: " + name);
  }
  void list(const Words&) {
    for (juce::AudioProcessorParameter* one : plugin().getParameters()) {
      const std::string name = one->getName(1024).toStdString();
      if (name.starts_with("MIDI CC ")) continue;  // stand for controllers in VST3
      std::cout << name << '\t' << one->getLabel() << '\t' << one->getValue() << '\t'
                << one->getCurrentValueAsText() << '\n';
    }
  }
  void set(const Words& words) {
    parameter(words.at(0)).setValueNotifyingHost(static_cast<float>(number(words.at(1))));
  }
  void text(const Words& words) {
    std::cout << parameter(words.at(0)).getText(static_cast<float>(number(words.at(1))), 1024)
              << '\n';
  }
  void value(const Words& words) {
    std::cout << parameter(words.at(0)).getValueForText(words.at(1)) << '\n';
  }
  void programs(const Words&) {
    for (int i = 0; i < plugin().getNumPrograms(); ++i)
      std::cout << plugin().getProgramName(i) << '\n';
  }
  void program(const Words& words) {
    for (int i = 0; i < plugin().getNumPrograms(); ++i) {
      if (plugin().getProgramName(i).toStdString() == words.at(0)) plugin().setCurrentProgram(i);
    }
  }

  void midi(const Words& words) {
    const auto byte = [&](std::size_t place) {
      return static_cast<juce::uint8>(whole(words.at(place)));
    };
    const bool is_short = (byte(1) & 0xE0) == 0xC0;
    events_.addEvent(is_short ? juce::MidiMessage(byte(1), byte(2))
                              : juce::MidiMessage(byte(1), byte(2), byte(3)),
                     whole(words.at(0)));
  }
  void point(const Words& words) {
    points_.emplace(whole(words.at(0)), Words(words.begin() + 1, words.end()));
  }
  void song(const Words& words) {
    song_.tell(number(words.at(0)), number(words.at(1)), words.at(2) == "1");
  }

  void play(const Words& words) {
    const int frames = whole(words.at(0)), most = whole(words.at(1));
    const int inputs = plugin().getTotalNumInputChannels(),
              outputs = plugin().getTotalNumOutputChannels();
    const std::string in = words.at(2) == "-" ? std::string() : file_text(words.at(2));
    const auto given = in.size() / sizeof(float);
    std::string midi;
    std::vector<float> sound(static_cast<std::size_t>(outputs) * static_cast<std::size_t>(frames));
    for (int from = 0; from < frames; from += most) {
      const int count = std::min(most, frames - from);
      juce::AudioBuffer<float> block(std::max(inputs, outputs), count);
      block.clear();
      for (int c = 0; c < inputs; ++c) {
        const auto place = static_cast<std::size_t>(c) * static_cast<std::size_t>(frames) +
                           static_cast<std::size_t>(from);
        if (place + static_cast<std::size_t>(count) > given) continue;
        std::memcpy(block.getWritePointer(c), in.data() + place * sizeof(float),
                    static_cast<std::size_t>(count) * sizeof(float));
      }
      process(block, from, midi);
      for (int c = 0; c < outputs; ++c) {
        std::copy_n(block.getReadPointer(c), count,
                    sound.begin() + static_cast<std::ptrdiff_t>(c) * frames + from);
      }
    }
    write_text(words.at(3), std::string(reinterpret_cast<const char*>(sound.data()),
                                        sound.size() * sizeof(float)));
    write_text(words.at(3) + ".midi", midi);
    events_.clear();
    points_.clear();
  }
  void process(juce::AudioBuffer<float>& block, int from, std::string& given) {
    const int count = block.getNumSamples();
    for (auto it = points_.lower_bound(from); it != points_.lower_bound(from + count); ++it)
      set(it->second);
    juce::MidiBuffer events;
    events.addEvents(events_, from, count, -from);
    plugin().processBlock(block, events);
    for (const juce::MidiMessageMetadata event : events) {
      given += std::to_string(from + event.samplePosition);
      for (int i = 0; i < event.numBytes; ++i) given += ' ' + std::to_string(event.data[i]);
      given += '\n';
    }
    song_.pass(count, rate_hz_);
  }

  void save(const Words& words) {
    juce::MemoryBlock state;
    plugin().getStateInformation(state);
    write_text(words.at(0),
               std::string(static_cast<const char*>(state.getData()), state.getSize()));
  }
  void restore(const Words& words) {
    const std::string state = file_text(words.at(0));
    plugin().setStateInformation(state.data(), static_cast<int>(state.size()));
  }
  /// Within what the plugin itself wrote: the last FROM becomes TO.
  void mangle(const Words& words) {
    std::string state = file_text(words.at(2));
    const auto replace = [&](std::string& text) {
      const std::size_t place = text.rfind(words.at(0));
      if (place == std::string::npos) fail("not in the state: " + words.at(0));
      text.replace(place, words.at(0).size(), words.at(1));
    };
    auto xml = juce::AudioProcessor::getXmlFromBinary(state.data(), static_cast<int>(state.size()));
    if (xml == nullptr) {
      replace(state);
      return write_text(words.at(3), state);
    }
    juce::XmlElement* const component = xml->getChildByName("IComponent");
    juce::MemoryBlock inside;
    inside.fromBase64Encoding(component->getAllSubText());
    std::string text(static_cast<const char*>(inside.getData()), inside.getSize());
    replace(text);
    component->deleteAllChildElements();
    component->addTextElement(juce::MemoryBlock(text.data(), text.size()).toBase64Encoding());
    juce::AudioProcessor::copyXmlToBinary(*xml, inside);
    write_text(words.at(3),
               std::string(static_cast<const char*>(inside.getData()), inside.getSize()));
  }
  void speak_german(const Words&) {
    if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) fail("no locale de_DE.UTF-8");
    std::cout << std::localeconv()->decimal_point << '\n';
  }

  std::unique_ptr<juce::AudioPluginFormat> format_;
  juce::KnownPluginList known_;
  Song song_;
  std::unique_ptr<juce::AudioPluginInstance> plugin_;
  double rate_hz_ = 0;
  juce::MidiBuffer events_;
  std::multimap<int, Words> points_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: juce_host vst3|lv2 SCRIPT\n";
    return 2;
  }
  const juce::ScopedJuceInitialiser_GUI message_thread;
  try {
    std::ifstream script(argv[2]);
    if (!script) fail(std::string("cannot read ") + argv[2]);
    Host(argv[1]).run(script);
  } catch (const std::exception& error) {
    std::cerr << "juce_host: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
