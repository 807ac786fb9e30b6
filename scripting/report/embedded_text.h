// Embeds a file in the program.
#pragma once

/// Defines the bytes of a file as begin[] .. end[] of the names given. To be used at file scope, outside of namespaces. The assembler includes the file
/// unchanged, so there is no generated source and no limit on the length of literals.
#define STERNA_EMBED_TEXT(begin, end, file) \
  asm(".pushsection .rodata\n" #begin       \
      ":\n"                                 \
      ".incbin \"" file "\"\n" #end         \
      ":\n"                                 \
      ".byte 0\n"                           \
      ".popsection\n"                       \
      ".globl " #begin                      \
      "\n"                                  \
      ".globl " #end "\n");                 \
  extern "C" {                              \
  extern const char begin[];                \
  extern const char end[];                  \
  }
