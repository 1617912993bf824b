# Thin face on the CMake presets: every target works in a fresh clone.
.PHONY: help setup build test demo studies format clean
.DEFAULT_GOAL := help

help:
	@echo "make build     the program build/release/scree and the library"
	@echo "make test      builds and runs every test"
	@echo "make demo      a pile of rocks, with pictures, in runs/demo"
	@echo "make studies   the studies in validation/; STUDY=name for one, QUICK=1 for a version of minutes in runs/quick"
	@echo "make format    formats the sources"
	@echo "make clean     removes build/"

setup:
	@tools/setup

# what runs scenes, without tests
build: setup
	@cmake --preset release --log-level=WARNING
	@cmake --build --preset release --target scree_program

test: setup
	@tests/run_all

demo: build
	@tools/demo

studies: build
	@tools/studies $(STUDY)

format:
	@git ls-files -z '*.c' '*.h' '*.cu' '*.cuh' '*.cpp' | xargs -0 clang-format -i

clean:
	rm -rf build
