#version 450 core
// Which triangle a sample shows, counted from 1: floats hold it exactly up to 2^24.
layout(location = 0) out float triangle;

void main() {
    triangle = float(gl_PrimitiveID + 1);
}
