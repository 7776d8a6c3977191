# lcm-gen 1.3.1's decoder believes a string length of 0 or less: std::length_error, or a read out of bounds.
s/if(\(__[a-z0-9_]*_len__\) > maxlen - pos)/if(\1 < 1 || \1 > maxlen - pos)/
