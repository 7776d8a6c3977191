# lcm-gen 1.3.1's decoder believes a string length of 0 or less, of a field and of an element of an array: std::length_error, or
# a read out of bounds.
s/if(\(__[a-z0-9_]*_len\(__\)\{0,1\}\) > maxlen - pos)/if(\1 < 1 || \1 > maxlen - pos)/
# It also believes the length of an array: a few bytes could ask for gigabytes. No element takes less than a byte.
s/^\( *\)this->[a-z0-9_]*\.resize(this->\([a-z0-9_]*\));/\1if(this->\2 < 0 || this->\2 > maxlen - pos) return -1;\n&/
