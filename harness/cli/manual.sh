#!/bin/sh
# Writes manual pages of PROGRAM into FOLDER, made of what --help prints: of itself, and of every command.
set -eu
program=$1 folder=$2
version=$("$program" --version)
write_page() {  # the words of a command
  name=$(echo shadowbench $1 | tr ' ' -)
  help=$("$program" $1 --help-all)
  help2man --no-info --help-option=--help-all --version-string="${version#* }" --name="$(echo "$help" | head -n 1)" "$program $1" |
    sed "s/^shadowbench[a-z ]* \\\\- /$name \\\\- /" | gzip -9n >"$folder/$name.1.gz"
  for command in $(echo "$help" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do write_page "$1 $command"; done
}
mkdir -p "$folder"
write_page ""
