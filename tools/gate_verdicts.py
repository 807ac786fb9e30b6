def main(words, root): return 0
