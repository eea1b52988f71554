# SPDX-License-Identifier: MIT
# Rules of GNU make for images. Enters: sources (.c, .cpp, .cc, .S, .s) beside the Makefile; leaves: .o, .d and .elf.
#
#   include $(shell torolux cc --makefile)
#   all: hello.elf image.elf          # hello.elf comes from hello.c, or hello.cpp, ...
#   image.elf: main.o other.o         # several sources
#
# CPPFLAGS, CFLAGS, CXXFLAGS, ASFLAGS, LDFLAGS and LDLIBS as in make's own rules. TOROLUX: the program, if it is not in PATH.
TOROLUX ?= torolux
CC = $(TOROLUX) cc
CXX = $(TOROLUX) cc
AR = riscv64-unknown-elf-ar

# What is newer than all that was compiled once Torolux has been installed anew.
torolux_kit := $(dir $(lastword $(MAKEFILE_LIST)))torolux.specs

# The first goal is the user's.
torolux_goal := $(.DEFAULT_GOAL)

%.o: %.c $(torolux_kit)
	$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@
%.o: %.cpp $(torolux_kit)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c $< -o $@
%.o: %.cc $(torolux_kit)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c $< -o $@
%.o: %.S $(torolux_kit)
	$(CC) $(CPPFLAGS) $(ASFLAGS) -MMD -MP -c $< -o $@
%.o: %.s $(torolux_kit)
	$(CC) $(ASFLAGS) -c $< -o $@

# An image: of the source of its name, and of whatever else is named for it. Headers are no part of a link, nor is a
# source whose object is one.
torolux_linked_as_objects = $(foreach kind,c cpp cc S s,$(patsubst %.o,%.$(kind),$(filter %.o,$^)))
torolux_parts = $(filter-out $(torolux_linked_as_objects),$(filter %.c %.cpp %.cc %.S %.s %.o %.a,$^))
torolux_compiled = $(CPPFLAGS) -MMD -MP -MT $@ $(LDFLAGS) $(torolux_parts) $(LDLIBS) -o $@

%.elf: %.c $(torolux_kit)
	$(CC) $(CFLAGS) $(torolux_compiled)
%.elf: %.cpp $(torolux_kit)
	$(CXX) $(CXXFLAGS) $(torolux_compiled)
%.elf: %.cc $(torolux_kit)
	$(CXX) $(CXXFLAGS) $(torolux_compiled)
%.elf: %.S $(torolux_kit)
	$(CC) $(ASFLAGS) $(torolux_compiled)
%.elf: $(torolux_kit)
	$(CC) $(CFLAGS) $(torolux_compiled)

# Objects stay; what they were made of is known from the last time.
.PRECIOUS: %.o
-include $(wildcard *.d */*.d)
.DEFAULT_GOAL := $(torolux_goal)
